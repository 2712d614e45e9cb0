// The frame around a command that calls a server: connect, be interruptible,
// answer with an exit code.
#ifndef MARROW_CLIENT_COMMAND_SERVICE_CALL_H_
#define MARROW_CLIENT_COMMAND_SERVICE_CALL_H_

#include <functional>
#include <memory>
#include <string>

#include "absl/base/thread_annotations.h"
#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/synchronization/mutex.h"
#include "client/client.h"
#include "client/command/arguments.h"
#include "client/command/connection.h"
#include "client/command/interrupt.h"
#include "client/encoder/mesh_payload.h"

namespace marrow::client {

// Make it before any other thread. Thread safe otherwise.
class ServiceCall {
 public:
  explicit ServiceCall(const ServiceArguments& arguments);
  ~ServiceCall();

  // Call once, and before client().
  absl::Status Connect(absl::Time deadline);
  Client& client() { return connection_->client(); }

  bool interrupted() const { return interrupt_.signal() != 0; }
  // The exit code of the whole command: that of the signal where one came.
  int ExitCode(int otherwise) const;

 private:
  const ServiceArguments& arguments_;
  std::unique_ptr<Connection> connection_;
  absl::Mutex mutex_;
  Client* cancellable_ ABSL_GUARDED_BY(mutex_) = nullptr;
  Interrupt interrupt_;  // the last: it uses the others
};

// A mesh file, read and encoded, and what is sent of it.
struct Input {
  PolygonMesh mesh;
  OrderMap order;
  Payload payload;
  std::string warning;  // of an option that had no effect; or empty
};
absl::StatusOr<Input> LoadInput(const std::string& path, uint32_t quantize,
                                absl::Time deadline);

// Each tells a person on standard error, unless they are to be quiet.
void TellWarning(const ServiceArguments& arguments, const std::string& file,
                 const Input& input);
void WarnOfIdleOptions(const ServiceArguments& arguments,
                       const MethodArguments& method);

// Tells a failure, as a line for a person or as JSON, and gives its exit code.
int TellFailure(const std::string& file, const absl::Status& status, bool json);

}  // namespace marrow::client

#endif  // MARROW_CLIENT_COMMAND_SERVICE_CALL_H_
