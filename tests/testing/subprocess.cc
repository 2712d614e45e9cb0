#include "tests/testing/subprocess.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

namespace marrow::testing {
namespace {

namespace fs = std::filesystem;

std::string TemporaryFile() {
  std::string path = (fs::temp_directory_path() / "marrow-XXXXXX").string();
  close(mkstemp(path.data()));
  return path;
}

std::vector<char*> Pointers(std::vector<std::string>& strings) {
  std::vector<char*> pointers;
  for (std::string& string : strings) pointers.push_back(string.data());
  pointers.push_back(nullptr);
  return pointers;
}

std::vector<std::string> Environment(const std::vector<std::string>& added) {
  std::vector<std::string> result = added;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    // A server that the person who runs the tests uses is not theirs.
    if (!std::string(*entry).starts_with("MARROW_SERVER=")) {
      result.push_back(*entry);
    }
  }
  return result;
}

}  // namespace

std::string ProgramPath(const std::string& name) {
  return (fs::read_symlink("/proc/self/exe").parent_path() / name).string();
}

Subprocess::Subprocess(const std::vector<std::string>& command,
                       const std::vector<std::string>& environment)
    : out_path_(TemporaryFile()), err_path_(TemporaryFile()) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, 1, out_path_.c_str(), O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&actions, 2, err_path_.c_str(), O_WRONLY, 0);
  std::vector<std::string> arguments = command;
  std::vector<std::string> variables = Environment(environment);
  const int error =
      posix_spawnp(&pid_, command[0].c_str(), &actions, nullptr,
                   Pointers(arguments).data(), Pointers(variables).data());
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) {
    ADD_FAILURE() << "cannot start " << command[0];
    ended_ = true;
    code_ = -1;
  }
}

Subprocess::~Subprocess() {
  if (!ended_) {
    Signal(SIGKILL);
    Wait();
  }
  unlink(out_path_.c_str());
  unlink(err_path_.c_str());
}

void Subprocess::Signal(int signal) const { kill(pid_, signal); }

bool Subprocess::WaitForOutput(const std::string& text) {
  for (int i = 0; i < 6000 && Out().find(text) == std::string::npos; ++i) {
    siginfo_t info{};
    waitid(P_PID, static_cast<id_t>(pid_), &info, WEXITED | WNOHANG | WNOWAIT);
    if (info.si_pid != 0) break;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return Out().find(text) != std::string::npos;
}

int Subprocess::Wait() {
  int status = 0;
  if (ended_ || waitpid(pid_, &status, 0) != pid_) return code_;
  ended_ = true;
  code_ = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  return code_;
}

std::string Subprocess::Out() const { return ReadFile(out_path_); }
std::string Subprocess::Err() const { return ReadFile(err_path_); }

Finished RunProgram(const std::vector<std::string>& command,
                    const std::vector<std::string>& environment) {
  Subprocess process(command, environment);
  const int code = process.Wait();
  return {.code = code, .out = process.Out(), .err = process.Err()};
}

TemporaryFolder::TemporaryFolder()
    : path_((fs::temp_directory_path() / "marrow-XXXXXX").string()) {
  if (mkdtemp(path_.data()) == nullptr) ADD_FAILURE() << "no folder " << path_;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

std::string ReadFile(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

void WriteFile(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

std::vector<std::string> ListFolder(const std::string& path) {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(path, error)) {
    names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace marrow::testing
