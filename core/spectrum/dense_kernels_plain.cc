namespace {
constexpr int kLanes = 2;
constexpr int kTileRows = 4;
}  // namespace

#include "core/spectrum/dense_kernels_body.h"

namespace marrow {

extern const DenseKernels kPlainKernels;
const DenseKernels kPlainKernels = KernelsNamed("plain");

}  // namespace marrow
