// The program itself, run as a child process.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "marrow/v1/capabilities_service.grpc.pb.h"
#include "marrow/v1/segmentation_service.grpc.pb.h"
#include "server/server.h"
#include "tests/server/test_mesh.h"

namespace marrow::testing {
namespace {

using ::testing::HasSubstr;

// As after a reader that hangs.
void FillPipe(int fd) {
  const std::string bytes(4096, '\n');
  fcntl(fd, F_SETFL, O_NONBLOCK);
  while (write(fd, bytes.data(), bytes.size()) > 0) {
  }
  fcntl(fd, F_SETFL, 0);
}

enum class LogPipe { kEmpty, kFull, kClosed };

// marrowd with its output in pipes.
class Daemon {
 public:
  explicit Daemon(std::vector<std::string> arguments,
                  LogPipe log = LogPipe::kEmpty) {
    int out[2];
    int err[2];
    EXPECT_EQ(pipe2(out, O_CLOEXEC), 0);
    EXPECT_EQ(pipe2(err, O_CLOEXEC), 0);
    if (log == LogPipe::kFull) FillPipe(err[1]);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, out[1], STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, err[1], STDERR_FILENO);
    if (log == LogPipe::kClosed) {
      posix_spawn_file_actions_addclose(&actions, STDERR_FILENO);
    }
    arguments.insert(arguments.begin(), MARROWD_PATH);
    std::vector<char*> argv;
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    EXPECT_EQ(posix_spawn(&pid_, MARROWD_PATH, &actions, nullptr, argv.data(),
                          environ),
              0);
    posix_spawn_file_actions_destroy(&actions);
    close(out[1]);
    close(err[1]);
    out_ = fdopen(out[0], "r");
    err_ = fdopen(err[0], "r");
  }
  ~Daemon() {
    if (pid_ > 0) {
      kill(pid_, SIGKILL);
      Wait();
    }
    fclose(out_);
    fclose(err_);
  }

  void Signal(int signal) { kill(pid_, signal); }

  // What stands behind a descriptor of its.
  std::string NameOf(int fd) const {
    return std::filesystem::read_symlink("/proc/" + std::to_string(pid_) +
                                         "/fd/" + std::to_string(fd))
        .string();
  }

  // Whether it ends by itself, within half a minute.
  bool Ends() const {
    siginfo_t info{};
    for (int i = 0; i < 3000 && info.si_pid == 0; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
      waitid(P_PID, static_cast<id_t>(pid_), &info,
             WEXITED | WNOHANG | WNOWAIT);
    }
    return info.si_pid != 0;
  }

  // The exit code.
  int Wait() {
    int status = 0;
    waitpid(pid_, &status, 0);
    pid_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

  std::string Line() { return ReadLine(out_); }
  std::string Errors() {
    std::string all;
    for (std::string line = ReadLine(err_); !line.empty();
         line = ReadLine(err_)) {
      all += line;
    }
    return all;
  }

  // "" where no address is printed.
  std::string Address() {
    const std::string line = Line();
    const std::string before =
        std::string("marrowd ") + kVersion + " listening on ";
    EXPECT_EQ(line.substr(0, before.size()), before);
    return line.substr(before.size(), line.size() - before.size() - 1);
  }

 private:
  static std::string ReadLine(FILE* file) {
    std::string line;
    for (int c = fgetc(file); c != EOF; c = fgetc(file)) {
      line += static_cast<char>(c);
      if (c == '\n') break;
    }
    return line;
  }

  pid_t pid_ = -1;
  FILE* out_ = nullptr;
  FILE* err_ = nullptr;
};

// Depths of a star whose call takes a tenth of a second, and some seconds.
constexpr int kShort = 4;
constexpr int kLong = 6;

// A call that has begun.
class Call {
 public:
  explicit Call(const std::string& address, int depth = kShort)
      : stub_(v1::SegmentationService::NewStub(
            grpc::CreateChannel(address, grpc::InsecureChannelCredentials()))) {
    v1::SegmentRequest request;
    request.mutable_mesh()->set_draco(StarPayload(depth));
    reader_ = stub_->Segment(&context_, request);
    v1::SegmentEvent event;
    EXPECT_TRUE(reader_->Read(&event));
  }
  grpc::Status Finish() {
    v1::SegmentEvent event;
    while (reader_->Read(&event)) {
    }
    return reader_->Finish();
  }

 private:
  std::unique_ptr<v1::SegmentationService::Stub> stub_;
  grpc::ClientContext context_;
  std::unique_ptr<grpc::ClientReader<v1::SegmentEvent>> reader_;
};

TEST(MarrowdTest, SigtermLetsARunningCallFinish) {
  Daemon daemon({"--port", "0"});
  Call call(daemon.Address());
  daemon.Signal(SIGTERM);
  EXPECT_TRUE(call.Finish().ok());
  EXPECT_EQ(daemon.Wait(), 0);
}

TEST(MarrowdTest, TheLogIsJsonLines) {
  Daemon daemon({"--listen", "127.0.0.1:0"});
  EXPECT_TRUE(Call(daemon.Address()).Finish().ok());
  daemon.Signal(SIGINT);
  EXPECT_EQ(daemon.Wait(), 0);
  std::istringstream lines(daemon.Errors());
  std::vector<std::string> messages;
  nlohmann::json call;
  for (std::string line; std::getline(lines, line);) {
    const auto json = nlohmann::json::parse(line);
    messages.push_back(json["message"]);
    if (messages.back() == "call") call = json;
  }
  EXPECT_EQ(messages, (std::vector<std::string>{"listening", "call", "draining",
                                                "stopped"}));
  EXPECT_EQ(call["method"], "SegmentationService.Segment");
  EXPECT_EQ(call["code"], "OK");
  EXPECT_EQ(call["mesh"].get<std::string>().size(), 12u);
  EXPECT_GT(call["seconds"].get<double>(), 0);
  EXPECT_FALSE(call["job"].get<std::string>().empty());
}

TEST(MarrowdTest, WhoeverHangsReadingTheLogHoldsUpNoCallAndNoSignal) {
  Daemon daemon({"--port", "0"}, LogPipe::kFull);
  const auto channel =
      grpc::CreateChannel(daemon.Address(), grpc::InsecureChannelCredentials());
  const auto stub = v1::CapabilitiesService::NewStub(channel);
  grpc::ClientContext context;
  context.set_deadline(std::chrono::system_clock::now() +
                       std::chrono::seconds(30));
  v1::GetCapabilitiesResponse response;
  EXPECT_TRUE(stub->GetCapabilities(&context, {}, &response).ok());
  daemon.Signal(SIGTERM);
  ASSERT_TRUE(daemon.Ends());
  EXPECT_EQ(daemon.Wait(), 0);
}

TEST(MarrowdTest, GraceEndsARunningCall) {
  Daemon daemon({"--port", "0", "--grace", "0", "--log-level", "off"});
  Call call(daemon.Address(), kLong);
  daemon.Signal(SIGTERM);
  EXPECT_FALSE(call.Finish().ok());
  EXPECT_EQ(daemon.Wait(), 0);
  EXPECT_EQ(daemon.Errors(), "");
}

TEST(MarrowdTest, ASecondSignalEndsItAtOnce) {
  Daemon daemon({"--port", "0"});
  Call call(daemon.Address(), kLong);
  daemon.Signal(SIGTERM);
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  daemon.Signal(SIGTERM);
  EXPECT_EQ(daemon.Wait(), 128 + SIGTERM);
  EXPECT_FALSE(call.Finish().ok());
}

TEST(MarrowdTest, ATakenPortIsSaid) {
  Daemon first({"--port", "0"});
  const std::string address = first.Address();
  Daemon second({"--listen", address});
  EXPECT_EQ(second.Wait(), 2);
  EXPECT_EQ(second.Errors().rfind("marrowd: cannot listen on " + address, 0),
            0u)
      << second.Errors();
}

TEST(MarrowdTest, NothingElseTakesThePlaceOfAClosedStream) {
  Daemon daemon({"--port", "0"}, LogPipe::kClosed);
  EXPECT_NE(daemon.Address(), "");
  EXPECT_EQ(daemon.NameOf(STDERR_FILENO), "/dev/null");
}

TEST(MarrowdTest, SizesThatAreNoneAreToldHowToWrite) {
  for (const std::string size : {"1e6", "1.5MiB", "many", "-4", ""}) {
    Daemon daemon({"--max-mesh-bytes", size});
    EXPECT_EQ(daemon.Wait(), 1);
    EXPECT_THAT(daemon.Errors(), HasSubstr("--max-mesh-bytes: '" + size +
                                           "' is no size; write"));
  }
}

TEST(MarrowdTest, AHostThatIsUnknownIsSaid) {
  Daemon daemon({"--listen", "no-such-host.invalid:0"});
  EXPECT_EQ(daemon.Wait(), 2);
  EXPECT_THAT(daemon.Errors(), HasSubstr("the host is unknown"));
}

TEST(MarrowdTest, WrongFlagsAreSaid) {
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"--threads", "-1"},
        {"--max-mesh-bytes", "many"},
        {"--max-mesh-bytes", "-4"},
        {"--no-such-flag"},
        {"--listen", ""},
        {"--listen", "127.0.0.1"},
        {"--listen", "127.0.0.1:http"},
        {"--listen", "127.0.0.1:65536"},
        {"--port", "0", "--grace", "nan"},
        {"--port", "0", "--mesh-store-bytes", "1KiB"}}) {
    Daemon daemon(arguments);
    EXPECT_EQ(daemon.Wait(), 1) << arguments.back();
    EXPECT_EQ(daemon.Errors().rfind("marrowd: ", 0), 0u) << arguments.back();
  }
}

TEST(MarrowdTest, SizesTakeSuffixes) {
  Daemon daemon({"--port", "0", "--max-mesh-bytes", "2MiB",
                 "--mesh-store-bytes", "3 mb", "--cache-bytes", "1GiB"});
  EXPECT_NE(daemon.Address(), "");
  daemon.Signal(SIGTERM);
  EXPECT_EQ(daemon.Wait(), 0);
}

TEST(MarrowdTest, VersionAndHelp) {
  Daemon version({"--version"});
  EXPECT_EQ(version.Line(), std::string("marrowd ") + kVersion + "\n");
  EXPECT_EQ(version.Wait(), 0);
  Daemon help({"--help"});
  EXPECT_EQ(help.Wait(), 0);
}

}  // namespace
}  // namespace marrow::testing
