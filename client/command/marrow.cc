// The `marrow` command.
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "client/command/exit_code.h"
#include "client/command/parse.h"

int main(int argc, char** argv) {
  // A reader that went away, as in `marrow spectrum x.off | head`, is no
  // reason to leave results half written.
  std::signal(SIGPIPE, SIG_IGN);
  const int code = marrow::client::RunCommandLine(argc, argv);
  if (code > marrow::client::kExitSignal) {
    // Threads of the service in this process may still run.
    std::fflush(stdout);
    std::_Exit(code);
  }
  errno = 0;
  if ((std::fflush(stdout) != 0 || std::ferror(stdout)) && errno != EPIPE) {
    std::fprintf(stderr, "marrow: cannot write to standard output: %s\n",
                 std::strerror(errno));
    return code == 0 ? marrow::client::kExitFailed : code;
  }
  return code;
}
