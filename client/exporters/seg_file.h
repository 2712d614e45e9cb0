// The .seg format of the Princeton segmentation benchmark.
#ifndef MARROW_CLIENT_EXPORTERS_SEG_FILE_H_
#define MARROW_CLIENT_EXPORTERS_SEG_FILE_H_

#include <cstdint>
#include <span>
#include <string>

namespace marrow {

// One decimal label a face, each on a line of its own, in the faces' order.
std::string SegFile(std::span<const uint32_t> face_labels);

}  // namespace marrow

#endif  // MARROW_CLIENT_EXPORTERS_SEG_FILE_H_
