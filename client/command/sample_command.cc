#include <filesystem>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "client/atomic_file.h"
#include "client/command/commands.h"
#include "client/command/exit_code.h"
#include "client/command/service_call.h"
#include "client/encoder/encode.h"
#include "client/exporters/seg_file.h"
#include "client/mesh_file/mesh_file.h"
#include "client/samples/samples.h"
#include "core/base/status_macros.h"

namespace marrow::client {
namespace {

void PrintSamples() {
  for (const SampleInfo& sample : ListSamples()) {
    absl::PrintF("%-10s %s\n%-10s poses: %s\n", sample.name, sample.description,
                 "", absl::StrJoin(sample.poses, ", "));
  }
}

bool IsDraco(const std::string& path) {
  return DetectMeshFormat(path, {}) == MeshFormat::kDraco;
}

absl::Status WriteSampleMesh(const PolygonMesh& mesh, const std::string& path) {
  if (!IsDraco(path)) return WriteMesh(mesh, path);
  MARROW_ASSIGN_OR_RETURN(const EncodedMesh encoded,
                          EncodeMesh(mesh, EncodeOptions()));
  return WriteFileAtomically(path, encoded.bytes);
}

// The parts of a .drc are in the order in which it was made, not in that in
// which it decodes, so the two do not go together.
absl::Status CheckOutputs(const SampleArguments& arguments) {
  const MeshFormat format = DetectMeshFormat(arguments.output, {});
  if (format == MeshFormat::kUnknown || format == MeshFormat::kGltf) {
    return absl::InvalidArgumentError(
        absl::StrCat(arguments.output,
                     ": cannot write this format; use .off, .obj, .ply, .stl "
                     "or .drc"));
  }
  if (!arguments.parts.empty() && format == MeshFormat::kDraco) {
    return absl::InvalidArgumentError(
        "--parts needs a mesh that keeps its face order: use -o with .off, "
        ".obj, .ply or .stl");
  }
  std::error_code ignored;
  if (!arguments.parts.empty() &&
      std::filesystem::weakly_canonical(arguments.parts, ignored) ==
          std::filesystem::weakly_canonical(arguments.output, ignored)) {
    return absl::InvalidArgumentError(
        "--parts and -o are one file: give --parts another name");
  }
  return absl::OkStatus();
}

absl::Status WriteSample(const SampleArguments& arguments) {
  MARROW_RETURN_IF_ERROR(CheckOutputs(arguments));
  MARROW_ASSIGN_OR_RETURN(
      const Sample sample,
      MakeSample(arguments.name, arguments.pose,
                 arguments.faces.value_or(kDefaultSampleFaces)));
  MARROW_RETURN_IF_ERROR(WriteSampleMesh(sample.mesh, arguments.output));
  if (!arguments.quiet)
    absl::PrintF("%s: %d vertices, %d faces -> %s\n", arguments.name,
                 sample.mesh.NumVertices(), sample.mesh.NumFaces(),
                 arguments.output);
  if (arguments.parts.empty()) return absl::OkStatus();
  MARROW_RETURN_IF_ERROR(
      WriteFileAtomically(arguments.parts, SegFile(sample.face_parts)));
  if (arguments.quiet) return absl::OkStatus();
  absl::PrintF("parts -> %s\n", arguments.parts);
  for (size_t part = 0; part < sample.part_names.size(); ++part) {
    absl::PrintF("  %d %s\n", part, sample.part_names[part]);
  }
  return absl::OkStatus();
}

}  // namespace

int RunSample(const SampleArguments& arguments) {
  if (arguments.list) {
    PrintSamples();
    return kExitOk;
  }
  const absl::Status status = WriteSample(arguments);
  if (status.ok()) return kExitOk;
  TellFailure("", status, false);
  return absl::IsInvalidArgument(status) ? kExitUsage : kExitFailed;
}

}  // namespace marrow::client
