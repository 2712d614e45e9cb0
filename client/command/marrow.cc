// The `marrow` command.
#include <fcntl.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <initializer_list>

#include "client/command/exit_code.h"
#include "client/command/parse.h"

namespace {

volatile std::sig_atomic_t reader_is_gone = 0;

void OnBrokenPipe(int) { reader_is_gone = 1; }

// A file opened in the place of a closed standard stream would receive what is
// printed. What stands in for an output cannot be written to, so that the
// loss is noticed.
void OpenStandardStreams(int, char**, char**) {
  for (const int fd : {0, 1, 2}) {
    if (fcntl(fd, F_GETFD) < 0) open("/dev/null", O_RDONLY);
  }
}

// In main it would be too late: gRPC opens an eventfd when it is loaded, which
// would be standard input, and reading that never ends. What stands in this
// section of a program runs before the initialisers of its libraries.
using Initialiser = void (*)(int, char**, char**);
[[gnu::section(".preinit_array"),
  gnu::used]] const Initialiser kBeforeLibraries = &OpenStandardStreams;

// Whether all that was printed has gone out, or nobody wants it.
bool FlushOutput() {
  return (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) ||
         reader_is_gone != 0;
}

}  // namespace

int main(int argc, char** argv) {
  // A reader that went away, as in `marrow spectrum x.off | head`, is no
  // reason to leave results half written.
  std::signal(SIGPIPE, OnBrokenPipe);
  // A file that may grow no more is as good as a full disk.
  std::signal(SIGXFSZ, SIG_IGN);
  const int code = marrow::client::RunCommandLine(argc, argv);
  if (code > marrow::client::kExitSignal) {
    // Threads of the service in this process may still run.
    std::fflush(stdout);
    std::_Exit(code);
  }
  if (!FlushOutput()) {
    std::fputs(
        "marrow: cannot write to standard output: it is closed, or its disk "
        "is full\n",
        stderr);
    return code == 0 ? marrow::client::kExitFailed : code;
  }
  return code;
}
