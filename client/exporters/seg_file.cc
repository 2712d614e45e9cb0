#include "client/exporters/seg_file.h"

#include "absl/strings/str_cat.h"

namespace marrow {

std::string SegFile(std::span<const uint32_t> face_labels) {
  std::string text;
  for (uint32_t label : face_labels) absl::StrAppend(&text, label, "\n");
  return text;
}

}  // namespace marrow
