#include "server/request_parser.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "absl/strings/str_cat.h"
#include "core/base/error_reason.h"
#include "core/base/status_macros.h"
#include "server/status.h"

namespace marrow {
namespace {

absl::StatusOr<Method> ParseMethod(v1::Method method) {
  if (method == v1::METHOD_UNSPECIFIED) return SegmentationOptions().method;
  if (method == v1::METHOD_PAPER) return Method::kPaper;
  if (method == v1::METHOD_MERGE) return Method::kMerge;
  return InvalidField("options.method",
                      absl::StrCat("this server does not know method ",
                                   static_cast<int>(method),
                                   "; GetCapabilities lists what it knows"));
}

absl::StatusOr<SegmentationOptions> ParseOptions(
    const v1::SegmentationOptions& message) {
  SegmentationOptions options;
  MARROW_ASSIGN_OR_RETURN(options.method, ParseMethod(message.method()));
  if (message.has_kappa()) options.split.kappa = message.kappa();
  if (message.has_delta()) options.split.delta = message.delta();
  if (message.has_epsilon()) options.split.epsilon = message.epsilon();
  if (message.has_tolerance()) options.split.tolerance = message.tolerance();
  if (message.has_eigen_pairs()) options.eigen_pairs = message.eigen_pairs();
  if (message.has_levels()) options.levels = message.levels();
  MARROW_RETURN_IF_ERROR(ValidateOptions(options));
  return options;
}

absl::Status ParseDomains(const v1::OutputSelection& message,
                          Outputs& outputs) {
  outputs.face_labels = message.label_domains().empty();
  for (int i = 0; i < message.label_domains_size(); ++i) {
    switch (message.label_domains(i)) {
      case v1::LABEL_DOMAIN_FACE:
        outputs.face_labels = true;
        break;
      case v1::LABEL_DOMAIN_VERTEX:
        outputs.point_labels = true;
        break;
      default:
        return InvalidField(
            absl::StrCat("outputs.label_domains[", i, "]"),
            absl::StrCat(static_cast<int>(message.label_domains(i)),
                         " is no domain; use FACE or VERTEX"));
    }
  }
  return absl::OkStatus();
}

absl::Status ParseLevels(const v1::OutputSelection& message, uint32_t deepest,
                         Outputs& outputs) {
  for (int i = 0; i < message.levels_size(); ++i) {
    const uint32_t level = message.levels(i);
    if (level < 1 || level > deepest) {
      return InvalidField(
          absl::StrCat("outputs.levels[", i, "]"),
          absl::StrCat("is ", level, "; must be 1 to options.levels, which is ",
                       deepest));
    }
    outputs.levels.insert(level);
  }
  for (uint32_t level = 1; message.levels().empty() && level <= deepest;
       ++level) {
    outputs.levels.insert(level);
  }
  return absl::OkStatus();
}

absl::StatusOr<CutSpec> ParseCut(const v1::Cut& message,
                                 const SegmentationOptions& options) {
  CutSpec cut;
  if (message.has_level()) cut = CutSpec::AtLevel(message.level());
  if (message.has_segments()) cut = CutSpec::Into(message.segments());
  if (message.has_salience()) cut = CutSpec::AtSalience(message.salience());
  cut.closed.assign(message.closed().begin(), message.closed().end());
  cut.open.assign(message.open().begin(), message.open().end());
  MARROW_RETURN_IF_ERROR(ValidateCut(cut, options));
  return cut;
}

absl::Status CheckSize(uint64_t size_bytes, const ServerOptions& limits,
                       const std::string& field) {
  const uint64_t most = limits.mesh_limits.max_bytes;
  if (size_bytes >= 1 && size_bytes <= most) return absl::OkStatus();
  return InvalidField(
      field, absl::StrCat("is ", size_bytes, " bytes; must be 1 to ", most,
                          ", this server's greatest mesh"));
}

absl::StatusOr<Payload> KeepInline(const std::string& bytes,
                                   const ServerOptions& limits,
                                   MeshStore& store) {
  if (bytes.empty()) {
    return InvalidField("mesh.draco", "is empty; send the bytes of a mesh");
  }
  MARROW_RETURN_IF_ERROR(CheckSize(bytes.size(), limits, "mesh.draco"));
  if (bytes.size() > limits.max_inline_mesh_bytes) {
    return InvalidField(
        "mesh.draco",
        absl::StrCat("has ", bytes.size(), " bytes, more than the ",
                     limits.max_inline_mesh_bytes,
                     " that a request may hold; upload it with "
                     "MeshStoreService.UploadMesh and send its digest"));
  }
  const Digest sha256 = Sha256(bytes);
  return Payload{{sha256, bytes.size()}, store.Put(sha256, bytes)};
}

}  // namespace

absl::StatusOr<SegmentParameters> ParseSegmentParameters(
    const v1::SegmentRequest& request) {
  SegmentParameters parameters;
  MARROW_ASSIGN_OR_RETURN(parameters.options, ParseOptions(request.options()));
  MARROW_RETURN_IF_ERROR(ParseDomains(request.outputs(), parameters.outputs));
  MARROW_RETURN_IF_ERROR(ParseLevels(
      request.outputs(), parameters.options.levels, parameters.outputs));
  parameters.outputs.skeletons = !request.outputs().omit_skeletons();
  if (request.has_cut()) {
    MARROW_ASSIGN_OR_RETURN(parameters.cut,
                            ParseCut(request.cut(), parameters.options));
  }
  return parameters;
}

absl::StatusOr<SegmentParameters> ParseCutParameters(
    const v1::CutRequest& request) {
  SegmentParameters parameters;
  MARROW_ASSIGN_OR_RETURN(parameters.options, ParseOptions(request.options()));
  MARROW_RETURN_IF_ERROR(ParseDomains(request.outputs(), parameters.outputs));
  parameters.outputs.skeletons = !request.outputs().omit_skeletons();
  MARROW_ASSIGN_OR_RETURN(parameters.cut,
                          ParseCut(request.cut(), parameters.options));
  return parameters;
}

absl::StatusOr<uint32_t> ParseEigenPairs(bool present, uint32_t value,
                                         const char* field) {
  if (!present) return SegmentationOptions().eigen_pairs;
  MARROW_RETURN_IF_ERROR(ValidateEigenPairs(value, field));
  return value;
}

absl::StatusOr<MeshDigest> ParseMeshDigest(const v1::MeshDigest& digest,
                                           const std::string& field,
                                           const ServerOptions& limits) {
  MeshDigest result;
  const std::string& sha256 = digest.sha256();
  if (sha256.size() != result.sha256.bytes.size()) {
    return InvalidField(
        field + ".sha256",
        absl::StrCat("has ", sha256.size(), " bytes; a SHA-256 has 32"));
  }
  std::copy(sha256.begin(), sha256.end(), result.sha256.bytes.begin());
  result.size_bytes = digest.size_bytes();
  MARROW_RETURN_IF_ERROR(
      CheckSize(result.size_bytes, limits, field + ".size_bytes"));
  return result;
}

absl::StatusOr<Payload> ResolveMesh(bool present, const v1::MeshSource& source,
                                    const ServerOptions& limits,
                                    MeshStore& store) {
  if (!present) return InvalidField("mesh", "is missing; give a mesh");
  switch (source.source_case()) {
    case v1::MeshSource::kDraco:
      return KeepInline(source.draco(), limits, store);
    case v1::MeshSource::kDigest: {
      Payload payload;
      MARROW_ASSIGN_OR_RETURN(
          payload.digest,
          ParseMeshDigest(source.digest(), "mesh.digest", limits));
      MARROW_ASSIGN_OR_RETURN(payload.bytes, store.Find(payload.digest));
      if (payload.bytes == nullptr) return MeshMissing(payload.digest.sha256);
      return payload;
    }
    default:
      return InvalidField("mesh.source",
                          "is not set; give a digest or Draco bytes");
  }
}

}  // namespace marrow
