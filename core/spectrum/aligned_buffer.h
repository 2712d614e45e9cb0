// An array of doubles that begins at a cache line.
#ifndef MARROW_CORE_SPECTRUM_ALIGNED_BUFFER_H_
#define MARROW_CORE_SPECTRUM_ALIGNED_BUFFER_H_

#include <cstddef>
#include <memory>
#include <new>

namespace marrow {

// Not initialised. Throws std::bad_alloc where there is no memory.
class AlignedBuffer {
 public:
  AlignedBuffer() = default;
  explicit AlignedBuffer(size_t size)
      : data_(static_cast<double*>(
            ::operator new(size * sizeof(double), kAlignment))) {}

  double* data() { return data_.get(); }
  const double* data() const { return data_.get(); }

 private:
  static constexpr std::align_val_t kAlignment{64};
  struct Free {
    void operator()(double* data) const { ::operator delete(data, kAlignment); }
  };
  std::unique_ptr<double, Free> data_;
};

}  // namespace marrow

#endif  // MARROW_CORE_SPECTRUM_ALIGNED_BUFFER_H_
