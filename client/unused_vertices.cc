#include "client/unused_vertices.h"

#include <string>

#include "absl/strings/str_cat.h"

namespace marrow::client {
namespace {

// As the server has it.
constexpr char kCode[] = "UNUSED_POINTS";

std::string Message(uint32_t count) {
  return absl::StrCat(count, count == 1 ? " vertex is" : " vertices are",
                      " in no face, and without a label");
}

}  // namespace

bool CountUnusedVertices(uint32_t count, v1::MeshReport& report) {
  if (report.unused_points() >= count) return false;
  report.set_unused_points(count);
  v1::Finding& finding = *report.add_findings();
  finding.set_code(kCode);
  finding.set_count(count);
  finding.set_message(Message(count));
  return true;
}

v1::Warning UnusedVerticesWarning(uint32_t count) {
  v1::Warning warning;
  warning.set_code(kCode);
  warning.set_message(Message(count));
  return warning;
}

}  // namespace marrow::client
