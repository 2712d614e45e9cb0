#include "core/mesh/draco_header.h"

#include <array>
#include <string>

#include "absl/strings/str_cat.h"
#include "core/base/error_reason.h"
#include "core/base/status_macros.h"

namespace marrow {
namespace {

constexpr std::string_view kMagic = "DRACO";
constexpr uint8_t kTriangularMesh = 1;
constexpr uint16_t kMetadataFlag = 0x8000;
// Draco's own bound on nesting; its destructor recurses.
constexpr size_t kMaxMetadataDepth = 1001;
constexpr uint64_t kMaxMetadataItems = 100'000;
constexpr uint64_t kMaxAttributeData = 8;
constexpr uint64_t kMaxAttributes = 64;
constexpr uint64_t kMaxAttributeBytes = 1ull << 30;
constexpr uint8_t kPosition = 0;
constexpr uint8_t kFloat32 = 9;
constexpr uint8_t kFloat64 = 10;
// By Draco's number of a data type; 0 is none.
constexpr std::array<uint8_t, 12> kTypeSizes = {0, 1, 1, 2, 2, 4,
                                                4, 8, 8, 4, 8, 1};

absl::Status Malformed(size_t byte, const std::string& what) {
  return WithReason(
      absl::InvalidArgumentError(absl::StrCat(
          "not a Draco mesh that can be read: byte ", byte, ": ", what)),
      kReasonDracoDecodeFailed);
}

absl::Status Rejected(const std::string& what) {
  return WithReason(absl::InvalidArgumentError(what), kReasonMeshRejected);
}

// Reads forward; every failure names the field and the byte.
class Reader {
 public:
  Reader(std::string_view bytes, size_t offset)
      : bytes_(bytes), offset_(offset) {}

  size_t offset() const { return offset_; }
  size_t remaining() const { return bytes_.size() - offset_; }

  absl::StatusOr<uint64_t> Fixed(size_t size, const char* field) {
    if (size > remaining()) return Ends(field);
    uint64_t value = 0;
    for (size_t i = 0; i < size; ++i) {
      value |= uint64_t{static_cast<uint8_t>(bytes_[offset_ + i])} << (8 * i);
    }
    offset_ += size;
    return value;
  }

  // Seven bits a byte, least significant first.
  absl::StatusOr<uint64_t> Varint(const char* field) {
    const size_t start = offset_;
    uint64_t value = 0;
    for (int shift = 0; shift < 35; shift += 7) {
      MARROW_ASSIGN_OR_RETURN(const uint64_t byte, Fixed(1, field));
      value |= (byte & 0x7F) << shift;
      if (byte < 0x80) {
        if (value > 0xFFFFFFFFu) break;
        return value;
      }
    }
    return Malformed(
        start, absl::StrCat("the ", field, " is not a number of 32 bits"));
  }

  absl::Status Skip(uint64_t size, const char* field) {
    if (size > remaining()) return Ends(field);
    offset_ += size;
    return absl::OkStatus();
  }

 private:
  absl::Status Ends(const char* field) const {
    return Malformed(bytes_.size(),
                     absl::StrCat("the file ends within the ", field));
  }

  std::string_view bytes_;
  size_t offset_;
};

// Entries are a name and a value, each behind its length.
absl::Status SkipMetadataEntries(Reader& reader, uint64_t& items) {
  MARROW_ASSIGN_OR_RETURN(const uint64_t count,
                          reader.Varint("number of metadata entries"));
  items += count;
  if (items > kMaxMetadataItems) {
    return Rejected(absl::StrCat("more than ", kMaxMetadataItems,
                                 " metadata entries; remove the metadata"));
  }
  for (uint64_t i = 0; i < count; ++i) {
    MARROW_ASSIGN_OR_RETURN(const uint64_t name_size,
                            reader.Fixed(1, "metadata name"));
    MARROW_RETURN_IF_ERROR(reader.Skip(name_size, "metadata name"));
    MARROW_ASSIGN_OR_RETURN(const uint64_t size,
                            reader.Varint("size of a metadata value"));
    if (size == 0) return Malformed(reader.offset(), "empty metadata value");
    MARROW_RETURN_IF_ERROR(reader.Skip(size, "metadata value"));
  }
  return absl::OkStatus();
}

// One tree of metadata. pending[d] counts the nodes still to come at depth d.
absl::Status SkipMetadata(Reader& reader, uint64_t& items) {
  std::array<uint64_t, kMaxMetadataDepth + 1> pending;
  pending[0] = 1;
  size_t depth = 0;
  while (true) {
    if (pending[depth] == 0) {
      if (depth == 0) return absl::OkStatus();
      --depth;
      continue;
    }
    --pending[depth];
    if (depth > 0) {
      MARROW_ASSIGN_OR_RETURN(const uint64_t name_size,
                              reader.Fixed(1, "metadata name"));
      MARROW_RETURN_IF_ERROR(reader.Skip(name_size, "metadata name"));
    }
    MARROW_RETURN_IF_ERROR(SkipMetadataEntries(reader, items));
    MARROW_ASSIGN_OR_RETURN(const uint64_t children,
                            reader.Varint("number of nested metadata"));
    items += children;
    if (children == 0) continue;
    if (depth == kMaxMetadataDepth || items > kMaxMetadataItems) {
      return Rejected(absl::StrCat("metadata nested deeper than ",
                                   kMaxMetadataDepth, " levels or more than ",
                                   kMaxMetadataItems,
                                   " entries; remove the metadata"));
    }
    pending[++depth] = children;
  }
}

// One tree for each attribute that has one, then one for the geometry.
absl::Status SkipGeometryMetadata(Reader& reader) {
  MARROW_ASSIGN_OR_RETURN(const uint64_t count,
                          reader.Varint("number of attribute metadata"));
  if (count > kMaxAttributes) {
    return Rejected(absl::StrCat("metadata for ", count,
                                 " attributes; at most ", kMaxAttributes,
                                 " are accepted"));
  }
  uint64_t items = 0;
  for (uint64_t i = 0; i < count; ++i) {
    MARROW_RETURN_IF_ERROR(reader.Varint("id of an attribute").status());
    MARROW_RETURN_IF_ERROR(SkipMetadata(reader, items));
  }
  return SkipMetadata(reader, items);
}

absl::Status CheckVersion(uint64_t major, uint64_t minor) {
  if (major == 2 && minor <= 2) return absl::OkStatus();
  return Malformed(
      5, absl::StrCat("bitstream version ", major, ".", minor,
                      " is not supported, only 2.0 to 2.2; encode the mesh "
                      "again with a current Draco encoder"));
}

absl::StatusOr<DracoHeader> ParseFileHeader(Reader& reader,
                                            std::string_view bytes) {
  if (bytes.substr(0, kMagic.size()) != kMagic) {
    return Malformed(0,
                     "the file does not begin with \"DRACO\"; compress the "
                     "mesh with a Draco encoder");
  }
  MARROW_RETURN_IF_ERROR(reader.Skip(kMagic.size(), "magic"));
  MARROW_ASSIGN_OR_RETURN(const uint64_t major, reader.Fixed(1, "version"));
  MARROW_ASSIGN_OR_RETURN(const uint64_t minor, reader.Fixed(1, "version"));
  MARROW_ASSIGN_OR_RETURN(const uint64_t type, reader.Fixed(1, "type"));
  if (type != kTriangularMesh) {
    return Malformed(7, type == 0 ? "this is a point cloud, which has no faces;"
                                    " send a triangle mesh"
                                  : "unknown type of geometry");
  }
  MARROW_RETURN_IF_ERROR(CheckVersion(major, minor));
  MARROW_ASSIGN_OR_RETURN(const uint64_t method, reader.Fixed(1, "method"));
  if (method > 1) {
    return Malformed(8, absl::StrCat("unknown encoding method ", method));
  }
  MARROW_ASSIGN_OR_RETURN(const uint64_t flags, reader.Fixed(2, "flags"));
  if ((flags & ~uint64_t{kMetadataFlag}) != 0) {
    return Malformed(9, "unknown flags are set");
  }
  if ((flags & kMetadataFlag) != 0) {
    MARROW_RETURN_IF_ERROR(SkipGeometryMetadata(reader));
  }
  DracoHeader header;
  header.version_minor = static_cast<uint8_t>(minor);
  header.method = static_cast<DracoMethod>(method);
  return header;
}

absl::Status CheckCounts(uint64_t faces, uint64_t vertices, size_t byte,
                         const MeshLimits& limits) {
  if (faces == 0) return Rejected("the mesh has no faces");
  if (faces > limits.max_faces) {
    return Rejected(absl::StrCat("the mesh declares ", faces,
                                 " faces, the limit is ", limits.max_faces,
                                 "; simplify it"));
  }
  if (vertices > limits.max_vertices) {
    return Rejected(absl::StrCat("the mesh declares ", vertices,
                                 " vertices, the limit is ",
                                 limits.max_vertices, "; simplify it"));
  }
  if (vertices < 3) {
    return Rejected(absl::StrCat("the mesh has ", vertices,
                                 " vertices, so all its faces are degenerate; "
                                 "a triangle takes three"));
  }
  if (vertices > 3 * faces) {
    return Malformed(
        byte, absl::StrCat(vertices, " vertices cannot belong to ", faces,
                           " faces; leave out vertices that no face uses"));
  }
  return absl::OkStatus();
}

absl::Status ParseSequential(Reader& reader, const MeshLimits& limits,
                             DracoHeader& header) {
  const size_t start = reader.offset();
  const auto count = [&](const char* field) {
    return header.version_minor < 2 ? reader.Fixed(4, field)
                                    : reader.Varint(field);
  };
  MARROW_ASSIGN_OR_RETURN(header.faces, count("number of faces"));
  MARROW_ASSIGN_OR_RETURN(header.vertices, count("number of points"));
  MARROW_RETURN_IF_ERROR(
      CheckCounts(header.faces, header.vertices, start, limits));
  MARROW_ASSIGN_OR_RETURN(const uint64_t method,
                          reader.Fixed(1, "connectivity method"));
  if (method > 1) return Malformed(start, "unknown connectivity method");
  return absl::OkStatus();
}

absl::Status CheckSymbols(uint64_t faces, uint64_t symbols, uint64_t splits,
                          size_t byte) {
  if (symbols > faces || faces > symbols + symbols / 3) {
    return Malformed(
        byte, absl::StrCat(symbols, " symbols cannot make ", faces, " faces"));
  }
  if (splits > symbols) {
    return Malformed(
        byte, absl::StrCat(splits, " splits among ", symbols, " symbols"));
  }
  return absl::OkStatus();
}

absl::Status ParseEdgebreaker(Reader& reader, const MeshLimits& limits,
                              DracoHeader& header) {
  const size_t start = reader.offset();
  MARROW_ASSIGN_OR_RETURN(const uint64_t traversal,
                          reader.Fixed(1, "traversal type"));
  if (traversal != 0 && traversal != 2) {
    return Malformed(start, absl::StrCat("unknown traversal type ", traversal));
  }
  if (header.version_minor < 2) {
    MARROW_RETURN_IF_ERROR(reader.Varint("number of new vertices").status());
  }
  MARROW_ASSIGN_OR_RETURN(header.vertices, reader.Varint("number of vertices"));
  MARROW_ASSIGN_OR_RETURN(header.faces, reader.Varint("number of faces"));
  MARROW_RETURN_IF_ERROR(
      CheckCounts(header.faces, header.vertices, start, limits));
  MARROW_ASSIGN_OR_RETURN(const uint64_t attribute_data,
                          reader.Fixed(1, "number of seam attributes"));
  if (attribute_data > kMaxAttributeData) {
    return Rejected(absl::StrCat(attribute_data,
                                 " attributes have seams of their own, the "
                                 "limit is ",
                                 kMaxAttributeData, "; remove some"));
  }
  MARROW_ASSIGN_OR_RETURN(const uint64_t symbols,
                          reader.Varint("number of symbols"));
  MARROW_ASSIGN_OR_RETURN(const uint64_t splits,
                          reader.Varint("number of splits"));
  return CheckSymbols(header.faces, symbols, splits, start);
}

// What the attributes seen so far ask for.
struct AttributeTotals {
  uint64_t count = 0;
  uint64_t positions = 0;
  uint64_t bytes_per_point = 0;
};

absl::Status CheckPosition(uint64_t data_type, uint64_t components) {
  if (components != 3) {
    return Rejected(absl::StrCat("POSITION has ", components,
                                 " components; it must have 3"));
  }
  if (data_type != kFloat32 && data_type != kFloat64) {
    return Rejected(
        "POSITION is not of type FLOAT32 or FLOAT64; encode "
        "floating-point positions");
  }
  return absl::OkStatus();
}

absl::Status ReadAttribute(Reader& reader, AttributeTotals& totals) {
  const size_t start = reader.offset();
  const char field[] = "description of an attribute";
  MARROW_ASSIGN_OR_RETURN(const uint64_t type, reader.Fixed(1, field));
  MARROW_ASSIGN_OR_RETURN(const uint64_t data_type, reader.Fixed(1, field));
  MARROW_ASSIGN_OR_RETURN(const uint64_t components, reader.Fixed(1, field));
  MARROW_RETURN_IF_ERROR(reader.Skip(1, field));  // normalized
  MARROW_RETURN_IF_ERROR(reader.Varint(field).status());
  if (data_type == 0 || data_type >= kTypeSizes.size() || components == 0) {
    return Malformed(start, "an attribute of unknown type or no components");
  }
  if (type == kPosition) {
    ++totals.positions;
    MARROW_RETURN_IF_ERROR(CheckPosition(data_type, components));
  }
  // Draco holds a value, its 32-bit integer form and two maps of the points.
  totals.bytes_per_point += components * (kTypeSizes[data_type] + 4) + 8;
  return absl::OkStatus();
}

absl::Status ReadAttributeGroup(Reader& reader, AttributeTotals& totals) {
  MARROW_ASSIGN_OR_RETURN(const uint64_t count,
                          reader.Varint("number of attributes"));
  totals.count += count;
  if (totals.count > kMaxAttributes) {
    return Rejected(absl::StrCat("more than ", kMaxAttributes,
                                 " attributes; only POSITION is used, remove "
                                 "the others"));
  }
  for (uint64_t i = 0; i < count; ++i) {
    MARROW_RETURN_IF_ERROR(ReadAttribute(reader, totals));
  }
  return reader.Skip(count, "attribute decoder types");
}

}  // namespace

absl::StatusOr<DracoHeader> ParseDracoHeader(std::string_view bytes,
                                             const MeshLimits& limits) {
  if (bytes.empty()) return Malformed(0, "the file is empty");
  if (bytes.size() > limits.max_bytes) {
    return Rejected(absl::StrCat("the mesh is of ", bytes.size(),
                                 " bytes, the limit is ", limits.max_bytes,
                                 "; simplify it or quantize it"));
  }
  Reader reader(bytes, 0);
  MARROW_ASSIGN_OR_RETURN(DracoHeader header, ParseFileHeader(reader, bytes));
  MARROW_RETURN_IF_ERROR(header.method == DracoMethod::kSequential
                             ? ParseSequential(reader, limits, header)
                             : ParseEdgebreaker(reader, limits, header));
  return header;
}

absl::Status CheckDracoAttributes(std::string_view bytes, size_t offset,
                                  DracoMethod method, uint64_t points) {
  Reader reader(bytes, offset);
  MARROW_ASSIGN_OR_RETURN(const uint64_t groups,
                          reader.Fixed(1, "number of attribute decoders"));
  if (method == DracoMethod::kEdgebreaker) {
    MARROW_RETURN_IF_ERROR(reader.Skip(3 * groups, "attribute decoders"));
  }
  AttributeTotals totals;
  for (uint64_t i = 0; i < groups; ++i) {
    MARROW_RETURN_IF_ERROR(ReadAttributeGroup(reader, totals));
  }
  if (totals.positions != 1) {
    return Rejected(absl::StrCat("the mesh has ", totals.positions,
                                 " POSITION attributes; it must have one"));
  }
  if (points * totals.bytes_per_point > kMaxAttributeBytes) {
    return Rejected(absl::StrCat(
        "the attributes of ", points, " points take ",
        points * totals.bytes_per_point, " bytes to decode, the limit is ",
        kMaxAttributeBytes, "; only POSITION is used, remove the others"));
  }
  return absl::OkStatus();
}

}  // namespace marrow
