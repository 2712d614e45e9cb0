#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"
#include "client/mesh_file/readers.h"
#include "client/mesh_file/text_scanner.h"
#include "core/base/status_macros.h"

namespace marrow {
namespace {

static_assert(std::endian::native == std::endian::little);

enum class Type {
  kInt8,
  kUint8,
  kInt16,
  kUint16,
  kInt32,
  kUint32,
  kFloat32,
  kFloat64
};

std::optional<Type> ParseType(std::string_view name) {
  struct Name {
    std::string_view text;
    Type type;
  };
  static constexpr Name kNames[] = {
      {"char", Type::kInt8},      {"int8", Type::kInt8},
      {"uchar", Type::kUint8},    {"uint8", Type::kUint8},
      {"short", Type::kInt16},    {"int16", Type::kInt16},
      {"ushort", Type::kUint16},  {"uint16", Type::kUint16},
      {"int", Type::kInt32},      {"int32", Type::kInt32},
      {"uint", Type::kUint32},    {"uint32", Type::kUint32},
      {"float", Type::kFloat32},  {"float32", Type::kFloat32},
      {"double", Type::kFloat64}, {"float64", Type::kFloat64}};
  for (const Name& name_and_type : kNames) {
    if (name_and_type.text == name) return name_and_type.type;
  }
  return std::nullopt;
}

size_t SizeOf(Type type) {
  switch (type) {
    case Type::kInt8:
    case Type::kUint8:
      return 1;
    case Type::kInt16:
    case Type::kUint16:
      return 2;
    case Type::kFloat64:
      return 8;
    default:
      return 4;
  }
}

struct Property {
  std::string_view name;
  Type type;
  std::optional<Type> count_type;  // set for a list
};

struct Element {
  std::string_view name;
  uint64_t count = 0;
  std::vector<Property> properties;
};

struct Header {
  bool ascii = false;
  bool big_endian = false;
  std::vector<Element> elements;
  size_t data_begin = 0;
};

// Reads the values one after another, whatever the encoding.
class ValueReader {
 public:
  virtual ~ValueReader() = default;
  // False where the data end or, in text, the token is no number. Floats come
  // through the double unchanged.
  virtual bool Next(Type type, double* value) = 0;
  virtual bool NextRow() = 0;  // to the next element
  virtual std::string Where() const = 0;
};

class BinaryReader final : public ValueReader {
 public:
  BinaryReader(std::string_view data, size_t begin, bool swap)
      : data_(data), position_(begin), swap_(swap) {}

  bool Next(Type type, double* value) override {
    const size_t size = SizeOf(type);
    if (data_.size() - position_ < size) return false;
    std::array<char, 8> raw = {};
    std::memcpy(raw.data(), data_.data() + position_, size);
    if (swap_) std::reverse(raw.begin(), raw.begin() + size);
    position_ += size;
    *value = Convert(type, raw);
    return true;
  }
  bool NextRow() override { return position_ < data_.size(); }
  std::string Where() const override {
    return absl::StrCat("byte ", position_);
  }

 private:
  template <typename T>
  static double As(const std::array<char, 8>& raw) {
    T value;
    std::memcpy(&value, raw.data(), sizeof(value));
    return static_cast<double>(value);
  }
  static double Convert(Type type, const std::array<char, 8>& raw) {
    switch (type) {
      case Type::kInt8:
        return As<int8_t>(raw);
      case Type::kUint8:
        return As<uint8_t>(raw);
      case Type::kInt16:
        return As<int16_t>(raw);
      case Type::kUint16:
        return As<uint16_t>(raw);
      case Type::kInt32:
        return As<int32_t>(raw);
      case Type::kUint32:
        return As<uint32_t>(raw);
      case Type::kFloat32:
        return As<float>(raw);
      case Type::kFloat64:
        return As<double>(raw);
    }
    return 0;
  }

  const std::string_view data_;
  size_t position_;
  const bool swap_;
};

class TextReader final : public ValueReader {
 public:
  explicit TextReader(TextScanner* scanner) : scanner_(*scanner) {}

  bool Next(Type type, double* value) override {
    const std::string_view token = scanner_.NextTokenAcrossLines();
    int64_t integer = 0;
    if (ParseInt64(token, &integer)) {
      *value = static_cast<double>(integer);
      // Kept apart: a negative zero is no integer.
      if (integer == 0 && token.front() == '-') *value = -0.0;
      return true;
    }
    if (type != Type::kFloat32) return ParseDouble(token, value);
    float number = 0;
    if (!ParseFloat(token, &number)) return false;
    *value = number;
    return true;
  }
  bool NextRow() override { return scanner_.NextLine(); }
  std::string Where() const override {
    return absl::StrCat("line ", scanner_.line());
  }

 private:
  TextScanner& scanner_;
};

class PlyReader {
 public:
  PlyReader(const std::string& path, std::string_view bytes)
      : path_(path),
        bytes_(bytes),
        scanner_(path, bytes, {.comments = false}) {}

  absl::StatusOr<PolygonMesh> Read();

 private:
  absl::Status ReadHeader();
  absl::Status ReadHeaderLine(std::string_view keyword);
  absl::Status ReadFormat();
  absl::Status ReadElementLine();
  absl::Status ReadPropertyLine();
  absl::Status CheckHeader();
  absl::Status ReadElement(const Element& element, ValueReader& reader);
  absl::Status ReadRow(const Element& element, uint64_t row,
                       ValueReader& reader);
  absl::Status ReadCorners(const Element& element, uint64_t row,
                           const Property& property, ValueReader& reader);
  absl::Status SkipValues(const Element& element, uint64_t row,
                          const Property& property, ValueReader& reader);
  absl::StatusOr<uint64_t> ReadListLength(const Element& element, uint64_t row,
                                          const Property& property,
                                          ValueReader& reader);
  absl::Status CheckCorners(size_t first_face) const;
  absl::Status CheckEnd(const Element& last, ValueReader& reader);
  absl::Status RowError(const Element& element, uint64_t row,
                        const ValueReader& reader,
                        const std::string& message) const {
    return absl::InvalidArgumentError(
        absl::StrCat(path_, ": ", reader.Where(), ": ",
                     std::string(element.name), " ", row, ": ", message));
  }

  const std::string path_;
  const std::string_view bytes_;
  TextScanner scanner_;
  Header header_;
  PolygonMesh mesh_;
};

bool IsCornerList(const Property& property) {
  return property.count_type.has_value() &&
         (property.name == "vertex_indices" || property.name == "vertex_index");
}

// 0, 1 or 2 for x, y or z; -1 for any other.
int AxisOf(const Property& property) {
  if (property.name.size() != 1 || property.count_type.has_value()) return -1;
  const char axis = property.name[0];
  return axis >= 'x' && axis <= 'z' ? axis - 'x' : -1;
}

absl::Status PlyReader::ReadFormat() {
  const std::string_view format = scanner_.NextToken();
  if (format == "ascii") {
    header_.ascii = true;
  } else if (format == "binary_big_endian") {
    header_.big_endian = true;
  } else if (format != "binary_little_endian") {
    return scanner_.Error(absl::StrCat("unknown format ", Quoted(format)));
  }
  return absl::OkStatus();
}

absl::Status PlyReader::ReadElementLine() {
  Element element;
  element.name = scanner_.NextToken();
  const std::string_view count = scanner_.NextToken();
  int64_t number = 0;
  // Every element that is read takes a byte at the least.
  if (!ParseInt64(count, &number) || number < 0 ||
      static_cast<uint64_t>(number) > bytes_.size()) {
    return scanner_.Error(
        absl::StrCat("the number of elements is ", Quoted(count),
                     ", which this file cannot hold; it may be cut off"));
  }
  element.count = static_cast<uint64_t>(number);
  header_.elements.push_back(std::move(element));
  return absl::OkStatus();
}

absl::Status PlyReader::ReadPropertyLine() {
  if (header_.elements.empty()) {
    return scanner_.Error("a property comes before any element");
  }
  Property property;
  std::string_view type = scanner_.NextToken();
  if (type == "list") {
    const std::string_view count_type = scanner_.NextToken();
    property.count_type = ParseType(count_type);
    if (!property.count_type.has_value()) {
      return scanner_.Error(absl::StrCat("unknown type ", Quoted(count_type)));
    }
    type = scanner_.NextToken();
  }
  const std::optional<Type> value_type = ParseType(type);
  if (!value_type.has_value()) {
    return scanner_.Error(absl::StrCat("unknown type ", Quoted(type)));
  }
  property.type = *value_type;
  property.name = scanner_.NextToken();
  header_.elements.back().properties.push_back(property);
  return absl::OkStatus();
}

absl::Status PlyReader::ReadHeaderLine(std::string_view keyword) {
  if (keyword == "format") return ReadFormat();
  if (keyword == "element") return ReadElementLine();
  if (keyword == "property") return ReadPropertyLine();
  if (keyword == "comment" || keyword == "obj_info") return absl::OkStatus();
  return scanner_.Error(
      absl::StrCat("unknown word in the header: ", Quoted(keyword)));
}

absl::Status PlyReader::CheckHeader() {
  bool has_corners = false;
  std::array<bool, 3> has_axis = {};
  for (const Element& element : header_.elements) {
    for (const Property& property : element.properties) {
      const int axis = AxisOf(property);
      if (element.name == "vertex" && axis >= 0) has_axis[axis] = true;
      if (element.name == "face") has_corners |= IsCornerList(property);
    }
  }
  if (!has_axis[0] || !has_axis[1] || !has_axis[2]) {
    return absl::InvalidArgumentError(
        absl::StrCat(path_, ": the vertices have no properties x, y and z"));
  }
  if (!has_corners) {
    return absl::InvalidArgumentError(absl::StrCat(
        path_,
        ": has no faces with a list vertex_indices (a point cloud, or "
        "triangle strips); save it with faces"));
  }
  return absl::OkStatus();
}

absl::Status PlyReader::ReadHeader() {
  if (scanner_.NextTokenAcrossLines() != "ply") {
    return scanner_.Error("a PLY file begins with 'ply'");
  }
  bool has_format = false;
  while (scanner_.NextLine()) {
    const std::string_view keyword = scanner_.NextToken();
    if (keyword == "end_header") {
      if (!has_format) return scanner_.Error("the header has no format line");
      header_.data_begin = scanner_.NextLineOffset();
      return CheckHeader();
    }
    has_format |= keyword == "format";
    MARROW_RETURN_IF_ERROR(ReadHeaderLine(keyword));
  }
  return scanner_.Error("the header has no end_header; it may be cut off");
}

absl::StatusOr<uint64_t> PlyReader::ReadListLength(const Element& element,
                                                   uint64_t row,
                                                   const Property& property,
                                                   ValueReader& reader) {
  double length = 0;
  if (!reader.Next(*property.count_type, &length)) {
    return RowError(element, row, reader,
                    "cannot read the length of a list; the file may be cut "
                    "off");
  }
  if (!(length >= 0 && length <= static_cast<double>(bytes_.size()))) {
    return RowError(element, row, reader,
                    absl::StrCat("a list cannot be ", length, " long"));
  }
  return static_cast<uint64_t>(length);
}

absl::Status PlyReader::SkipValues(const Element& element, uint64_t row,
                                   const Property& property,
                                   ValueReader& reader) {
  MARROW_ASSIGN_OR_RETURN(const uint64_t length,
                          ReadListLength(element, row, property, reader));
  double ignored = 0;
  for (uint64_t i = 0; i < length; ++i) {
    if (!reader.Next(property.type, &ignored)) {
      return RowError(element, row, reader,
                      absl::StrCat("cannot read ", std::string(property.name)));
    }
  }
  return absl::OkStatus();
}

// Indices are checked once all vertices are known: the faces may come first.
absl::Status PlyReader::ReadCorners(const Element& element, uint64_t row,
                                    const Property& property,
                                    ValueReader& reader) {
  MARROW_ASSIGN_OR_RETURN(const uint64_t length,
                          ReadListLength(element, row, property, reader));
  double index = 0;
  for (uint64_t i = 0; i < length; ++i) {
    if (!reader.Next(property.type, &index)) {
      return RowError(element, row, reader,
                      "cannot read a vertex index; the file may be cut off");
    }
    if (!(index >= 0 && index < 4294967295.0)) {
      return RowError(element, row, reader,
                      absl::StrCat("vertex index ", index, " is out of range"));
    }
    mesh_.face_vertices.push_back(static_cast<uint32_t>(index));
  }
  return absl::OkStatus();
}

absl::Status PlyReader::ReadRow(const Element& element, uint64_t row,
                                ValueReader& reader) {
  const bool is_vertex = element.name == "vertex";
  const bool is_face = element.name == "face";
  std::array<double, 3> position = {};
  for (const Property& property : element.properties) {
    if (is_face && IsCornerList(property)) {
      MARROW_RETURN_IF_ERROR(ReadCorners(element, row, property, reader));
      continue;
    }
    if (property.count_type.has_value()) {
      MARROW_RETURN_IF_ERROR(SkipValues(element, row, property, reader));
      continue;
    }
    double value = 0;
    if (!reader.Next(property.type, &value)) {
      return RowError(element, row, reader,
                      absl::StrCat("cannot read ", std::string(property.name),
                                   "; the file may be cut off"));
    }
    const int axis = is_vertex ? AxisOf(property) : -1;
    // In text, floats may be written with more digits than they hold.
    if (property.type == Type::kFloat32) value = ToFloat(value);
    if (axis >= 0) position[axis] = value;
  }
  if (is_vertex) mesh_.positions.push_back(position);
  if (is_face) {
    mesh_.face_offsets.push_back(
        static_cast<uint32_t>(mesh_.face_vertices.size()));
  }
  return absl::OkStatus();
}

absl::Status PlyReader::ReadElement(const Element& element,
                                    ValueReader& reader) {
  if (element.properties.empty()) return absl::OkStatus();
  for (uint64_t row = 0; row < element.count; ++row) {
    if (!reader.NextRow()) {
      return absl::InvalidArgumentError(absl::StrCat(
          path_, ": the file ends after ", row, " of ", element.count,
          " elements '", std::string(element.name), "'; it may be cut off"));
    }
    MARROW_RETURN_IF_ERROR(ReadRow(element, row, reader));
  }
  return absl::OkStatus();
}

absl::Status PlyReader::CheckCorners(size_t first_face) const {
  for (size_t f = first_face; f < mesh_.NumFaces(); ++f) {
    for (const uint32_t vertex : mesh_.Face(f)) {
      if (vertex < mesh_.NumVertices()) continue;
      return absl::InvalidArgumentError(
          absl::StrCat(path_, ": face ", f, ": vertex index ", vertex,
                       " is out of range (the file has ", mesh_.NumVertices(),
                       " vertices, counted from 0)"));
    }
  }
  return absl::OkStatus();
}

// Padding may follow the last element, but no more triangles or polygons.
absl::Status PlyReader::CheckEnd(const Element& last, ValueReader& reader) {
  if (last.name != "face") return absl::OkStatus();
  const size_t faces = mesh_.NumFaces();
  const size_t end = mesh_.face_vertices.size();
  size_t found = faces;
  while (reader.NextRow() && ReadRow(last, found, reader).ok() &&
         mesh_.Face(faces).size() >= 3 && CheckCorners(faces).ok()) {
    ++found;
    mesh_.face_offsets.resize(faces + 1);
    mesh_.face_vertices.resize(end);
  }
  mesh_.face_offsets.resize(faces + 1);
  mesh_.face_vertices.resize(end);
  if (found == faces) return absl::OkStatus();
  return absl::InvalidArgumentError(absl::StrCat(
      path_, ": the number of faces is ", faces, ", but the file has ", found,
      "; export it anew, or mend the number in the header"));
}

absl::StatusOr<PolygonMesh> PlyReader::Read() {
  MARROW_RETURN_IF_ERROR(ReadHeader());
  TextReader text_reader(&scanner_);
  BinaryReader binary_reader(bytes_, header_.data_begin, header_.big_endian);
  ValueReader& reader = header_.ascii
                            ? static_cast<ValueReader&>(text_reader)
                            : static_cast<ValueReader&>(binary_reader);
  for (const Element& element : header_.elements) {
    if (element.name == "vertex") mesh_.positions.reserve(element.count);
    if (element.name == "face") {
      mesh_.face_offsets.reserve(element.count + 1);
      mesh_.face_vertices.reserve(3 * element.count);
    }
    MARROW_RETURN_IF_ERROR(ReadElement(element, reader));
  }
  MARROW_RETURN_IF_ERROR(CheckCorners(0));
  MARROW_RETURN_IF_ERROR(CheckEnd(header_.elements.back(), reader));
  return std::move(mesh_);
}

}  // namespace

absl::StatusOr<PolygonMesh> ReadPly(const std::string& path,
                                    std::string_view bytes) {
  return PlyReader(path, bytes).Read();
}

}  // namespace marrow
