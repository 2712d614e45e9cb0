// What `marrow` returns to the shell. The help text lists them.
#ifndef MARROW_CLIENT_COMMAND_EXIT_CODE_H_
#define MARROW_CLIENT_COMMAND_EXIT_CODE_H_

namespace marrow::client {

inline constexpr int kExitOk = 0;
// Something failed: a file, or writing what came of it.
inline constexpr int kExitFailed = 1;
// The command line asks for something impossible; nothing was written.
inline constexpr int kExitUsage = 2;
// The server cannot be reached, or was lost.
inline constexpr int kExitUnreachable = 3;
// Stopped by signal n: kExitSignal + n, 130 for Ctrl-C.
inline constexpr int kExitSignal = 128;

}  // namespace marrow::client

#endif  // MARROW_CLIENT_COMMAND_EXIT_CODE_H_
