// Bytes to send, and how many faces and points they decode to.
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
};

}  // namespace marrow::client

#endif  // MARROW_CLIENT_PAYLOAD_H_
