#include <cstdio>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "client/command/commands.h"
#include "client/command/exit_code.h"
#include "client/command/reporter.h"
#include "client/command/service_call.h"
#include "client/message_json.h"
#include "core/base/status_macros.h"

namespace marrow::client {
namespace {

constexpr char kInspectSchema[] = "marrow.inspection/1";

void PrintCount(const char* what, uint64_t count) {
  absl::PrintF("  %-24s %d\n", what, count);
}

void PrintBox(const v1::MeshReport& report) {
  absl::PrintF("  %-24s %g %g %g to %g %g %g\n", "box", report.box_min().x(),
               report.box_min().y(), report.box_min().z(), report.box_max().x(),
               report.box_max().y(), report.box_max().z());
}

const char* WhyNoGenus(const v1::MeshReport& report) {
  if (report.nonmanifold_edges() > 0 || report.nonmanifold_vertices() > 0)
    return "the surface is not manifold";
  if (report.boundary_edges() > 0) return "the surface is open";
  return "the surface has one side";
}

void PrintForPerson(const std::string& file, const PolygonMesh& mesh,
                    const v1::InspectMeshResponse& response) {
  const v1::MeshReport& report = response.report();
  absl::PrintF("%s\n", file);
  PrintCount("vertices of the file", mesh.positions.size());
  PrintCount("faces of the file", mesh.NumFaces());
  PrintCount("vertices", report.vertices());
  PrintCount("faces", report.faces());
  PrintCount("components", report.components());
  PrintCount("bodies", report.bodies());
  if (report.bridging_distance() > 0)
    absl::PrintF("  %-24s %g\n", "bridging distance",
                 report.bridging_distance());
  PrintCount("boundary loops", report.boundary_loops());
  PrintCount("boundary edges", report.boundary_edges());
  PrintCount("non-manifold edges", report.nonmanifold_edges());
  PrintCount("non-manifold vertices", report.nonmanifold_vertices());
  PrintCount("degenerate faces", report.degenerate_faces());
  PrintCount("duplicate faces", report.duplicate_faces());
  PrintCount("inner wall faces", report.inner_wall_faces());
  PrintCount("zero-area faces", report.zero_area_faces());
  PrintCount("sliver faces", report.sliver_faces());
  PrintCount("flipped faces", report.flipped_faces());
  PrintCount("unused points", report.unused_points());
  PrintCount("edges to flip", response.edge_flips());
  absl::PrintF("  %-24s %g of a mean edge\n", "edges lengthened by",
               response.mollification());
  absl::PrintF("  %-24s %d\n", "Euler characteristic",
               report.euler_characteristic());
  if (report.has_genus()) {
    PrintCount("genus", report.genus());
  } else {
    absl::PrintF("  %-24s none: %s\n", "genus", WhyNoGenus(report));
  }
  absl::PrintF("  %-24s %g\n", "area", report.area());
  PrintBox(report);
  absl::PrintF("  %-24s %.1f s, %.0f MiB%s\n", "segmenting takes about",
               response.predicted_seconds(),
               static_cast<double>(response.predicted_bytes()) / (1 << 20),
               response.spectrum_cached() ? ", spectrum kept" : "");
  absl::PrintF("  %-24s %s\n", "geometry",
               HexOf(response.geometry_digest().sha256()));
  for (const v1::Finding& finding : report.findings()) {
    absl::PrintF("  %s\n", finding.message());
  }
}

nlohmann::json ToJson(const std::string& file,
                      const v1::InspectMeshResponse& response) {
  return {{"schema", kInspectSchema},
          {"file", file},
          {"report", ReportJson(response.report())},
          {"mesh_digest", HexOf(response.mesh_digest().sha256())},
          {"geometry_digest", HexOf(response.geometry_digest().sha256())},
          {"spectrum_cached", response.spectrum_cached()},
          {"predicted_seconds", response.predicted_seconds()},
          {"predicted_bytes", response.predicted_bytes()},
          {"edge_flips", response.edge_flips()},
          {"mollification", response.mollification()}};
}

absl::Status Inspect(const InspectArguments& arguments, ServiceCall& call) {
  const absl::Time deadline = arguments.service.Deadline();
  MARROW_ASSIGN_OR_RETURN(
      const Input input,
      LoadInput(arguments.file, arguments.service.quantize, deadline));
  TellWarning(arguments.service, arguments.file, input);
  MARROW_RETURN_IF_ERROR(call.Connect(deadline));
  MARROW_ASSIGN_OR_RETURN(
      const v1::InspectMeshResponse response,
      call.client().Inspect(input.payload, deadline - absl::Now()));
  if (arguments.service.json) {
    PrintJsonLine(ToJson(arguments.file, response));
  } else if (!arguments.service.quiet) {
    PrintForPerson(arguments.file, input.mesh, response);
  }
  return absl::OkStatus();
}

}  // namespace

int RunInspect(const InspectArguments& arguments) {
  ServiceCall call(arguments.service);
  const absl::Status status = Inspect(arguments, call);
  if (status.ok() || call.interrupted()) return call.ExitCode(kExitOk);
  return TellFailure(arguments.file, status, arguments.service.json);
}

}  // namespace marrow::client
