namespace {
constexpr int kLanes = 4;
constexpr int kTileRows = 4;
}  // namespace

#include "core/spectrum/dense_kernels_body.h"

namespace marrow {

extern const DenseKernels kAvx2Kernels;
const DenseKernels kAvx2Kernels = KernelsNamed("avx2");

}  // namespace marrow
