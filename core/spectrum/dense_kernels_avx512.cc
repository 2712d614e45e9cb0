namespace {
constexpr int kLanes = 8;
constexpr int kTileRows = 8;
}  // namespace

#include "core/spectrum/dense_kernels_body.h"

namespace marrow {

extern const DenseKernels kAvx512Kernels;
const DenseKernels kAvx512Kernels = KernelsNamed("avx512");

}  // namespace marrow
