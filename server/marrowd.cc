// The server program: flags, log and signals around server/server.h.
#include <fcntl.h>
#include <grpc/support/log.h>
#include <pthread.h>
#include <signal.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <memory>
#include <string>
#include <thread>

#include "absl/strings/numbers.h"
#include "absl/synchronization/notification.h"
#include "absl/time/time.h"
#include "server/json_log.h"
#include "server/server.h"

namespace {

using marrow::JsonLog;
using marrow::LogLevel;
using marrow::LogRecord;
using marrow::Server;
using marrow::ServerOptions;

constexpr int kExitUsage = 1;
constexpr int kExitCannotListen = 2;
constexpr int kSignalExitBase = 128;
constexpr absl::Duration kLogPatience = absl::Seconds(2);

struct Flags {
  ServerOptions options;
  int port = -1;
  double grace_seconds = 30;
  std::string log_level = "info";
  bool no_reflection = false;
};

constexpr char kFooter[] = R"(
Example:
  marrowd --listen 127.0.0.1:50051 --cache-bytes 4GiB
  marrow segment creature.obj --server 127.0.0.1:50051

Once it is ready it prints one line, "marrowd VERSION listening on HOST:PORT",
to standard output. The log goes to standard error, one JSON object a line.
There is no encryption and no login: listen beyond this machine only behind a
proxy that has both.

SIGTERM or SIGINT: takes no new calls, lets running calls finish for --grace,
then ends. A second one ends at once.

Exit codes: 0 after SIGTERM or SIGINT; 1 wrong flags; 2 cannot listen, for
instance because the port is taken; 130 or 143 ended by a second signal.)";

// HOST:PORT. gRPC would take a bare host for port 443.
std::string CheckAddress(const std::string& text) {
  const size_t colon = text.rfind(':');
  uint32_t port = 0;
  const bool good = colon != std::string::npos && colon > 0 &&
                    absl::SimpleAtoi(text.substr(colon + 1), &port) &&
                    port <= 65535;
  return good ? "" : "'" + text + "' is not HOST:PORT";
}

std::string CheckFinite(const std::string& text) {
  double value = 0;
  return absl::SimpleAtod(text, &value) && std::isfinite(value)
             ? ""
             : "'" + text + "' is no number";
}

// Makes a number of bytes of a size, and an error where that cannot be.
std::string ReadSize(std::string& text) {
  constexpr uint64_t kMost = uint64_t{1} << 50;
  const std::string given = text;
  uint64_t value = 0;
  try {
    const CLI::AsSizeValue bytes(false);
    // CLI11 lets -1 wrap around.
    if (bytes(text).empty() && absl::SimpleAtoi(text, &value) &&
        value <= kMost) {
      return "";
    }
  } catch (const CLI::ValidationError&) {
  }
  return "'" + given +
         "' is no size; write a whole number of bytes up to 1 PiB, or with a "
         "unit, such as 64MiB";
}

void AddLimits(CLI::App& app, ServerOptions& options) {
  const CLI::Validator bytes(&ReadSize, "");
  app.add_option("--max-mesh-bytes", options.mesh_limits.max_bytes,
                 "Largest mesh that is taken, such as 64MiB")
      ->transform(bytes)
      ->capture_default_str();
  app.add_option("--max-faces", options.mesh_limits.max_faces,
                 "Most faces of a mesh")
      ->check(CLI::Range(uint64_t{1}, uint64_t{1} << 30))
      ->capture_default_str();
  app.add_option("--max-vertices", options.mesh_limits.max_vertices,
                 "Most points of a mesh, those split by seams apart")
      ->check(CLI::Range(uint64_t{3}, uint64_t{1} << 30))
      ->capture_default_str();
  app.add_option("--cache-bytes", options.cache_bytes,
                 "Memory for eigen-pairs of earlier calls, such as 1GiB; 0 "
                 "keeps none")
      ->transform(bytes)
      ->capture_default_str();
  app.add_option("--result-cache-bytes", options.result_cache_bytes,
                 "Memory for results of earlier calls, whose trees Cut cuts "
                 "again; 0 keeps none")
      ->transform(bytes)
      ->capture_default_str();
  app.add_option("--mesh-store-bytes", options.mesh_store_bytes,
                 "Memory for uploaded meshes; at least --max-mesh-bytes")
      ->transform(bytes)
      ->capture_default_str();
  app.add_option("--threads", options.compute_threads,
                 "Threads that compute, a call each; 0: one a core")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  app.add_option("--max-queue", options.max_queued_jobs,
                 "Calls that may wait for a thread; others are refused with "
                 "UNAVAILABLE")
      ->check(CLI::Range(0, 1'000'000))
      ->capture_default_str();
}

void AddFlags(CLI::App& app, Flags& flags) {
  app.add_option("--listen", flags.options.listen,
                 "HOST:PORT to listen on; port 0 takes a free one")
      ->check(CheckAddress)
      ->capture_default_str();
  app.add_option("--port", flags.port, "Short for --listen 127.0.0.1:PORT")
      ->check(CLI::Range(0, 65535))
      ->excludes("--listen");
  AddLimits(app, flags.options);
  app.add_option("--grace", flags.grace_seconds,
                 "Seconds that running calls have to finish after SIGTERM")
      ->check(CheckFinite)
      ->check(CLI::Range(0.0, 86400.0))
      ->capture_default_str();
  app.add_option("--log-level", flags.log_level, "Least level that is logged")
      ->check(
          CLI::IsMember({"trace", "debug", "info", "warning", "error", "off"}))
      ->capture_default_str();
  app.add_flag("--no-reflection", flags.no_reflection,
               "Does not tell callers the services by gRPC reflection");
  app.set_version_flag("--version", std::string("marrowd ") + marrow::kVersion);
  app.footer(kFooter);
  app.failure_message([](const CLI::App*, const CLI::Error& error) {
    return std::string("marrowd: ") + error.what() + "; see marrowd --help\n";
  });
}

// A socket in the place of a closed standard stream would receive what is
// printed.
void OpenStandardStreams(int, char**, char**) {
  for (const int fd : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (fcntl(fd, F_GETFD) < 0) open("/dev/null", O_RDWR);
  }
}

// In main it would be too late: gRPC opens an eventfd when it is loaded. What
// stands in this section of a program runs before the initialisers of its
// libraries.
using Initialiser = void (*)(int, char**, char**);
[[gnu::section(".preinit_array"),
  gnu::used]] const Initialiser kBeforeLibraries = &OpenStandardStreams;

sigset_t StopSignals() {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGTERM);
  sigaddset(&set, SIGINT);
  return set;
}

int NextStopSignal() {
  const sigset_t set = StopSignals();
  int signal = 0;
  while (sigwait(&set, &signal) != 0) {
  }
  return signal;
}

struct StopSignal {
  absl::Notification came;
  int number = 0;  // once it came
};

// The first signal. A second one ends the process at once, whatever that waits
// for. Call it before any other thread is made, so that all inherit the mask
// and none but the one that waits for signals sees them.
const StopSignal& TakeStopSignals() {
  const sigset_t stop_signals = StopSignals();
  pthread_sigmask(SIG_BLOCK, &stop_signals, nullptr);
  StopSignal& first = *new StopSignal;  // for a thread that never ends
  std::thread([&first] {
    first.number = NextStopSignal();
    first.came.Notify();
    std::_Exit(kSignalExitBase + NextStopSignal());
  }).detach();
  return first;
}

// gRPC's own messages become records of ours, once the server listens: until
// then what goes wrong is said in a word of our own.
JsonLog* grpc_log = nullptr;
std::atomic<bool> grpc_may_log = false;

void LogFromGrpc(gpr_log_func_args* args) {
  if (!grpc_may_log) return;
  LogRecord record;
  record.level = args->severity == GPR_LOG_SEVERITY_ERROR  ? LogLevel::kWarning
                 : args->severity == GPR_LOG_SEVERITY_INFO ? LogLevel::kInfo
                                                           : LogLevel::kDebug;
  record.message = args->message;
  record.fields.emplace_back("from", "grpc");
  grpc_log->Write(record);
}

std::string Address(const ServerOptions& options, int port) {
  return options.listen.substr(0, options.listen.rfind(':') + 1) +
         std::to_string(port);
}

int Serve(const Flags& flags, const StopSignal& stop, JsonLog& log) {
  auto server = Server::Start(flags.options);
  if (!server.ok()) {
    std::cerr << "marrowd: " << server.status().message() << std::endl;
    return absl::IsInvalidArgument(server.status()) ? kExitUsage
                                                    : kExitCannotListen;
  }
  grpc_may_log = true;
  const std::string address = Address(flags.options, (*server)->port());
  std::cout << "marrowd " << marrow::kVersion << " listening on " << address
            << std::endl;
  log.Write({LogLevel::kInfo, "listening", {{"address", address}}, {}});

  stop.came.WaitForNotification();
  log.Write(
      {LogLevel::kInfo, "draining", {{"signal", strsignal(stop.number)}}, {}});
  (*server)->Drain(std::chrono::milliseconds(
      static_cast<int64_t>(flags.grace_seconds * 1000)));
  server->reset();
  log.Write({LogLevel::kInfo, "stopped", {}, {}});
  log.Flush(kLogPatience);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  const StopSignal& stop = TakeStopSignals();
  signal(SIGPIPE, SIG_IGN);

  CLI::App app(
      "Marrow's server: takes meshes of creatures over gRPC and streams back "
      "their parts and skeletons.",
      "marrowd");
  Flags flags;
  AddFlags(app, flags);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kExitUsage;
  }
  if (flags.port >= 0) {
    flags.options.listen = "127.0.0.1:" + std::to_string(flags.port);
  }
  flags.options.reflection = !flags.no_reflection;

  // Never destroyed: gRPC's threads may log until the process is gone.
  JsonLog& log = *new JsonLog(flags.log_level);
  grpc_log = &log;
  gpr_set_log_function(&LogFromGrpc);
  flags.options.log = [&log](const LogRecord& record) { log.Write(record); };
  return Serve(flags, stop, log);
}
