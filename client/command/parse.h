// The command line of `marrow`: its options, its help, its errors.
#ifndef MARROW_CLIENT_COMMAND_PARSE_H_
#define MARROW_CLIENT_COMMAND_PARSE_H_

namespace marrow::client {

// Parses the command line and runs the subcommand. Returns its exit code, or
// kExitOk after --help and --version, or kExitUsage after telling what is
// wrong.
int RunCommandLine(int argc, const char* const* argv);

}  // namespace marrow::client

#endif  // MARROW_CLIENT_COMMAND_PARSE_H_
