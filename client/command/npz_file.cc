#include "client/command/npz_file.h"

#include <minizip/zip.h>

#include <algorithm>
#include <bit>
#include <cstdio>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "core/base/status_macros.h"

namespace marrow::client {
namespace {

// The functions by which minizip writes to what it takes for a file: it goes
// back to fill in the size and the checksum of each member.
struct Memory {
  std::string bytes;
  size_t position = 0;
};

Memory& AsMemory(voidpf stream) { return *static_cast<Memory*>(stream); }

voidpf Open(voidpf memory, const void*, int) { return memory; }

uLong Read(voidpf, voidpf, void*, uLong) { return 0; }

uLong Write(voidpf, voidpf stream, const void* data, uLong size) {
  Memory& memory = AsMemory(stream);
  const char* from = static_cast<const char*>(data);
  const size_t inside =
      std::min<size_t>(size, memory.bytes.size() - memory.position);
  std::copy_n(from, inside,
              memory.bytes.begin() + static_cast<ptrdiff_t>(memory.position));
  memory.bytes.append(from + inside, size - inside);
  memory.position += size;
  return size;
}

ZPOS64_T Tell(voidpf, voidpf stream) { return AsMemory(stream).position; }

long Seek(voidpf, voidpf stream, ZPOS64_T offset, int origin) {
  Memory& memory = AsMemory(stream);
  size_t from = 0;
  if (origin == ZLIB_FILEFUNC_SEEK_CUR) from = memory.position;
  if (origin == ZLIB_FILEFUNC_SEEK_END) from = memory.bytes.size();
  if (from + offset > memory.bytes.size()) return -1;
  memory.position = from + offset;
  return 0;
}

int Nothing(voidpf, voidpf) { return 0; }

absl::Status CheckZip(int code) {
  return code == ZIP_OK ? absl::OkStatus()
                        : absl::InternalError(absl::StrCat(
                              "cannot make the .npz archive: error ", code));
}

void AppendBytes(uint64_t value, size_t count, std::string& bytes) {
  for (size_t b = 0; b < count; ++b)
    bytes += static_cast<char>(value >> (8 * b));
}

// The shape as a Python tuple.
std::string Tuple(const std::vector<size_t>& shape) {
  return absl::StrCat("(", absl::StrJoin(shape, ", "),
                      shape.size() == 1 ? "," : "", ")");
}

}  // namespace

std::string NpyHeader(const std::string& type,
                      const std::vector<size_t>& shape) {
  constexpr size_t kPreamble = 10;  // magic, version, length of the header
  constexpr size_t kAlignment = 64;
  std::string header =
      absl::StrCat("{'descr': '", type,
                   "', 'fortran_order': True, 'shape': ", Tuple(shape), ", }");
  header.append(kAlignment - (kPreamble + header.size() + 1) % kAlignment, ' ');
  header += '\n';
  std::string file("\x93NUMPY\x01\0", 8);
  AppendBytes(header.size(), 2, file);
  return file + header;
}

void AppendDouble(double value, std::string& bytes) {
  AppendBytes(std::bit_cast<uint64_t>(value), sizeof(value), bytes);
}

struct NpzFile::State {
  Memory memory;
  zipFile zip = nullptr;
};

NpzFile::NpzFile() : state_(std::make_unique<State>()) {
  zlib_filefunc64_def functions = {.zopen64_file = Open,
                                   .zread_file = Read,
                                   .zwrite_file = Write,
                                   .ztell64_file = Tell,
                                   .zseek64_file = Seek,
                                   .zclose_file = Nothing,
                                   .zerror_file = Nothing,
                                   .opaque = &state_->memory};
  state_->zip = zipOpen2_64("", APPEND_STATUS_CREATE, nullptr, &functions);
}

NpzFile::~NpzFile() {
  if (state_->zip != nullptr) zipClose(state_->zip, nullptr);
}

absl::Status NpzFile::Begin(const std::string& name, const std::string& type,
                            const std::vector<size_t>& shape, size_t bytes) {
  constexpr size_t kZip64From = 0xFFFF0000;
  zip_fileinfo info = {};
  info.dosDate = 0x21;  // 1980-01-01, the first there is
  const std::string header = NpyHeader(type, shape);
  state_->memory.bytes.reserve(state_->memory.bytes.size() + bytes + 4096);
  MARROW_RETURN_IF_ERROR(CheckZip(zipOpenNewFileInZip64(
      state_->zip, absl::StrCat(name, ".npy").c_str(), &info, nullptr, 0,
      nullptr, 0, nullptr, 0, 0, header.size() + bytes >= kZip64From)));
  return Append(header);
}

absl::Status NpzFile::Append(std::string_view values) {
  constexpr size_t kMost = 1 << 30;
  while (!values.empty()) {
    const size_t size = std::min(values.size(), kMost);
    MARROW_RETURN_IF_ERROR(CheckZip(zipWriteInFileInZip(
        state_->zip, values.data(), static_cast<unsigned>(size))));
    values.remove_prefix(size);
  }
  return absl::OkStatus();
}

absl::Status NpzFile::AddDoubles(const std::string& name,
                                 const std::vector<double>& values) {
  std::string bytes;
  for (double value : values) AppendDouble(value, bytes);
  MARROW_RETURN_IF_ERROR(Begin(name, "<f8", {values.size()}, bytes.size()));
  return Append(bytes);
}

absl::Status NpzFile::AddNumber(const std::string& name, double value) {
  std::string bytes;
  AppendDouble(value, bytes);
  MARROW_RETURN_IF_ERROR(Begin(name, "<f8", {}, bytes.size()));
  return Append(bytes);
}

absl::Status NpzFile::AddCount(const std::string& name, int64_t value) {
  std::string bytes;
  AppendBytes(static_cast<uint64_t>(value), sizeof(value), bytes);
  MARROW_RETURN_IF_ERROR(Begin(name, "<i8", {}, bytes.size()));
  return Append(bytes);
}

absl::Status NpzFile::AddText(const std::string& name,
                              const std::string& text) {
  std::string bytes;
  for (const char c : text)
    AppendBytes(static_cast<unsigned char>(c), 4, bytes);
  MARROW_RETURN_IF_ERROR(
      Begin(name, absl::StrCat("<U", text.size()), {}, bytes.size()));
  return Append(bytes);
}

absl::StatusOr<std::string> NpzFile::Finish() {
  MARROW_RETURN_IF_ERROR(
      CheckZip(zipClose(std::exchange(state_->zip, nullptr), nullptr)));
  return std::move(state_->memory.bytes);
}

}  // namespace marrow::client
