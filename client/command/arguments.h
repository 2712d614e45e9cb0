// What the command line asked for.
#ifndef MARROW_CLIENT_COMMAND_ARGUMENTS_H_
#define MARROW_CLIENT_COMMAND_ARGUMENTS_H_

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "absl/time/clock.h"
#include "absl/time/time.h"
#include "marrow/v1/segmentation_service.pb.h"

namespace marrow::client {

// A file in flight is held in memory as mesh, payload and answer.
inline constexpr uint32_t kMaxFilesAtOnce = 16;

// What all commands that call a server share.
struct ServiceArguments {
  std::string server;             // empty: compute in this process
  std::optional<double> timeout;  // seconds a file
  uint32_t threads = 0;           // at most kMaxFilesAtOnce; 0: one a core
  uint32_t quantize = 0;          // bits a coordinate; 0: lossless
  bool json = false;
  bool quiet = false;

  // Of a file whose work begins now.
  absl::Time Deadline() const {
    return timeout.has_value() ? absl::Now() + absl::Seconds(*timeout)
                               : absl::InfiniteFuture();
  }
};

// How the tree is cut.
struct CutChoice {
  std::string text = "auto";     // as CheckCutText() allows
  std::vector<uint32_t> closed;  // ids of nodes
  std::vector<uint32_t> open;
};

// An absent parameter has the server's default.
struct MethodArguments {
  v1::Method method = v1::METHOD_UNSPECIFIED;
  std::optional<double> kappa;
  std::optional<double> delta;
  std::optional<double> epsilon;
  std::optional<double> tolerance;
  std::optional<uint32_t> pairs;
  std::optional<uint32_t> levels;

  v1::SegmentationOptions ToMessage() const {
    v1::SegmentationOptions options;
    options.set_method(method);
    if (kappa) options.set_kappa(*kappa);
    if (delta) options.set_delta(*delta);
    if (epsilon) options.set_epsilon(*epsilon);
    if (tolerance) options.set_tolerance(*tolerance);
    if (pairs) options.set_eigen_pairs(*pairs);
    if (levels) options.set_levels(*levels);
    return options;
  }
};

struct SegmentArguments {
  std::vector<std::string> files;
  std::string folder = ".";
  MethodArguments method;
  CutChoice cut;
  bool parts = false;
  bool png = false;
  ServiceArguments service;
};

struct CutArguments {
  std::string file;
  std::string folder = ".";
  MethodArguments method;
  CutChoice cut;
  bool parts = false;
  bool png = false;
  ServiceArguments service;
};

struct InspectArguments {
  std::string file;
  ServiceArguments service;
};

struct SpectrumArguments {
  std::string file;
  std::optional<uint32_t> pairs;
  bool strict = false;
  // Where the eigenvectors go: an .npz archive, "-" for one on standard output,
  // any other name for a bare .npy matrix; empty: nowhere.
  std::string output;
  ServiceArguments service;
};

struct SampleArguments {
  bool list = false;
  std::string name;
  std::string pose;
  std::string output;
  std::string parts;
  std::optional<uint32_t> faces;
  bool quiet = false;
};

}  // namespace marrow::client

#endif  // MARROW_CLIENT_COMMAND_ARGUMENTS_H_
