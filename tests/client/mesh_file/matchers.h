// What the tests of the readers share.
#ifndef MARROW_TESTS_CLIENT_MESH_FILE_MATCHERS_H_
#define MARROW_TESTS_CLIENT_MESH_FILE_MATCHERS_H_

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <initializer_list>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/mesh_file/mesh_file.h"
#include "client/polygon_mesh.h"

namespace marrow {

inline std::vector<std::vector<uint32_t>> Faces(const PolygonMesh& mesh) {
  std::vector<std::vector<uint32_t>> faces;
  for (size_t f = 0; f < mesh.NumFaces(); ++f) {
    faces.emplace_back(mesh.Face(f).begin(), mesh.Face(f).end());
  }
  return faces;
}

inline PolygonMesh ParseOrFail(const std::string& path,
                               const std::string& bytes) {
  absl::StatusOr<PolygonMesh> mesh = ParseMesh(path, bytes);
  EXPECT_TRUE(mesh.ok()) << mesh.status();
  return mesh.ok() ? *std::move(mesh) : PolygonMesh();
}

// Parsing fails as INVALID_ARGUMENT, and the message has every part.
inline void ExpectRefused(const std::string& path, const std::string& bytes,
                          std::initializer_list<const char*> parts) {
  const absl::Status status = ParseMesh(path, bytes).status();
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument) << bytes;
  const std::string message(status.message());
  EXPECT_EQ(message.rfind(path + ": ", 0), 0u) << message;
  for (const char* part : parts) {
    EXPECT_THAT(message, ::testing::HasSubstr(part));
  }
}

inline void ExpectConsistent(const PolygonMesh& mesh) {
  ASSERT_GT(mesh.NumFaces(), 0u);
  ASSERT_EQ(mesh.face_offsets.back(), mesh.face_vertices.size());
  for (const uint32_t v : mesh.face_vertices) {
    ASSERT_LT(v, mesh.NumVertices());
  }
}

// Cuts the bytes at every length and changes every byte in several ways: each
// time there is an error or a mesh whose indices are in range.
inline void ExpectSurvivesDamage(const std::string& path,
                                 const std::string& bytes) {
  const auto check = [&path](const std::string& damaged) {
    const absl::StatusOr<PolygonMesh> mesh = ParseMesh(path, damaged);
    if (mesh.ok()) ExpectConsistent(*mesh);
  };
  for (size_t size = 0; size < bytes.size(); ++size) {
    check(bytes.substr(0, size));
    for (const char change : {'\x01', '\x10', '\x80', '\xFF', ' '}) {
      std::string damaged = bytes;
      damaged[size] = static_cast<char>(damaged[size] ^ change);
      check(damaged);
    }
  }
}

}  // namespace marrow

#endif  // MARROW_TESTS_CLIENT_MESH_FILE_MATCHERS_H_
