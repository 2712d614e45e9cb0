// Real programs, run by tests.
#ifndef MARROW_TESTS_TESTING_SUBPROCESS_H_
#define MARROW_TESTS_TESTING_SUBPROCESS_H_

#include <sys/types.h>

#include <string>
#include <vector>

namespace marrow::testing {

// Where `marrow` and `marrowd` stand: beside the test itself.
std::string ProgramPath(const std::string& name);

// A program that runs. Its standard input is empty, its standard output and
// error go to files. Killed where it still runs at the end.
class Subprocess {
 public:
  // `environment` adds to the test's own: {"MARROW_SERVER=..."}.
  explicit Subprocess(const std::vector<std::string>& command,
                      const std::vector<std::string>& environment = {});
  ~Subprocess();
  Subprocess(const Subprocess&) = delete;
  Subprocess& operator=(const Subprocess&) = delete;

  void Signal(int signal) const;
  // Waits until the text is in what the program wrote so far to standard
  // output; false after a minute, or where it ended without it.
  bool WaitForOutput(const std::string& text);
  // Waits for the end: the exit code, or minus the signal that ended it.
  int Wait();

  std::string Out() const;
  std::string Err() const;

 private:
  pid_t pid_ = -1;
  bool ended_ = false;
  int code_ = 0;
  std::string out_path_;
  std::string err_path_;
};

struct Finished {
  int code = 0;
  std::string out;
  std::string err;
};

Finished RunProgram(const std::vector<std::string>& command,
                    const std::vector<std::string>& environment = {});

// A folder of the test's own, removed with all in it.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::string& path() const { return path_; }
  std::string operator/(const std::string& name) const {
    return path_ + "/" + name;
  }

 private:
  std::string path_;
};

std::string ReadFile(const std::string& path);
void WriteFile(const std::string& path, const std::string& bytes);
// The names in a folder, sorted, hidden ones too; empty where there is none.
std::vector<std::string> ListFolder(const std::string& path);

}  // namespace marrow::testing

#endif  // MARROW_TESTS_TESTING_SUBPROCESS_H_
