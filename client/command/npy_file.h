// Matrices as NumPy's .npy files.
#ifndef MARROW_CLIENT_COMMAND_NPY_FILE_H_
#define MARROW_CLIENT_COMMAND_NPY_FILE_H_

#include <cstddef>
#include <span>
#include <string>

namespace marrow::client {

// Format version 1.0, little-endian float64, a column after the other
// ("fortran order"): value (row, column) is values[column * rows + row].
// REQUIRES: values.size() == rows * columns.
std::string NpyFile(std::span<const double> values, size_t rows,
                    size_t columns);

}  // namespace marrow::client

#endif  // MARROW_CLIENT_COMMAND_NPY_FILE_H_
