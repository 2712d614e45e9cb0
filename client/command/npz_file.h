// Arrays as NumPy's .npy files, and several of them as an .npz archive.
#ifndef MARROW_CLIENT_COMMAND_NPZ_FILE_H_
#define MARROW_CLIENT_COMMAND_NPZ_FILE_H_

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

namespace marrow::client {

// What stands before the values in a .npy file, format version 1.0. `type` is
// NumPy's, such as "<f8"; values follow with the first index varying fastest
// ("fortran order"). An empty shape is a scalar.
std::string NpyHeader(const std::string& type,
                      const std::vector<size_t>& shape);

// Appends a little-endian float64.
void AppendDouble(double value, std::string& bytes);

// A zip archive of .npy files, in memory, without compression: eigenvectors
// have none to give. Beyond 4 GiB it is of the Zip64 kind. Equal arrays give
// equal bytes. Not thread safe.
class NpzFile {
 public:
  NpzFile();
  ~NpzFile();

  // Adds the array `name`; its values are those appended until the next one.
  // `bytes` is how many that will be.
  absl::Status Begin(const std::string& name, const std::string& type,
                     const std::vector<size_t>& shape, size_t bytes);
  absl::Status Append(std::string_view values);

  absl::Status AddDoubles(const std::string& name,
                          const std::vector<double>& values);
  absl::Status AddNumber(const std::string& name, double value);
  absl::Status AddCount(const std::string& name, int64_t value);
  // `text` is ASCII.
  absl::Status AddText(const std::string& name, const std::string& text);

  // Call once, last. The archive.
  absl::StatusOr<std::string> Finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace marrow::client

#endif  // MARROW_CLIENT_COMMAND_NPZ_FILE_H_
