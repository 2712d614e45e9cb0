#include "client/command/npy_file.h"

#include <bit>
#include <cstdint>

#include "absl/strings/str_cat.h"

namespace marrow::client {

std::string NpyFile(std::span<const double> values, size_t rows,
                    size_t columns) {
  constexpr size_t kPreamble = 10;  // magic, version, length of the header
  constexpr size_t kAlignment = 64;
  std::string header =
      absl::StrCat("{'descr': '<f8', 'fortran_order': True, 'shape': (", rows,
                   ", ", columns, "), }");
  header.append(kAlignment - (kPreamble + header.size() + 1) % kAlignment, ' ');
  header += '\n';
  std::string file = "\x93NUMPY\x01";
  file += '\0';
  file += static_cast<char>(header.size() & 0xFF);
  file += static_cast<char>(header.size() >> 8);
  file += header;
  file.reserve(file.size() + sizeof(double) * values.size());
  for (double value : values) {
    const uint64_t bits = std::bit_cast<uint64_t>(value);
    for (size_t b = 0; b < sizeof(bits); ++b) {
      file += static_cast<char>(bits >> (8 * b));
    }
  }
  return file;
}

}  // namespace marrow::client
