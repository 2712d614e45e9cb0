// Bytes to send, how many faces and points they decode to, and what of the file
// they lack.
#ifndef MARROW_CLIENT_PAYLOAD_H_
#define MARROW_CLIENT_PAYLOAD_H_

#include <cstdint>
#include <string>

namespace marrow::client {

// The counts are what an answer is checked against: a server cannot make the
// client hold more labels than the mesh that was sent has.
struct Payload {
  std::string draco;
  uint32_t num_faces = 0;
  uint32_t num_points = 0;
  // Vertices of the file that no face uses. Where they are not sent, the server
  // cannot count them, and its reports are completed.
  uint32_t num_unused_vertices = 0;
};

}  // namespace marrow::client

#endif  // MARROW_CLIENT_PAYLOAD_H_
