#include "core/spectrum/dense_kernels.h"

#include <array>

namespace marrow {

extern const DenseKernels kPlainKernels;
#if defined(__x86_64__)
extern const DenseKernels kAvx2Kernels;
extern const DenseKernels kAvx512Kernels;
#endif

namespace {

using KernelList = std::array<const DenseKernels*, 4>;

KernelList ListKernels() {
  KernelList list{&kPlainKernels};
#if defined(__x86_64__)
  int count = 1;
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
    list[count++] = &kAvx2Kernels;
  if (__builtin_cpu_supports("avx512f")) list[count++] = &kAvx512Kernels;
#endif
  return list;
}

const KernelList& List() {
  static const KernelList list = ListKernels();
  return list;
}

}  // namespace

const DenseKernels* const* AllKernels() { return List().data(); }

const DenseKernels& Kernels() {
  const DenseKernels* const* best = AllKernels();
  while (best[1] != nullptr) ++best;
  return **best;
}

}  // namespace marrow
