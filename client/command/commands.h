// The subcommands of `marrow`. Each returns an exit code (exit_code.h), writes
// what it found to standard output and failures to standard error.
#ifndef MARROW_CLIENT_COMMAND_COMMANDS_H_
#define MARROW_CLIENT_COMMAND_COMMANDS_H_

#include <string>

#include "client/command/arguments.h"

namespace marrow::client {

int RunSegment(const SegmentArguments& arguments);
int RunCut(const CutArguments& arguments);
int RunInspect(const InspectArguments& arguments);
int RunSpectrum(const SpectrumArguments& arguments);
int RunSample(const SampleArguments& arguments);
int RunHealth(const std::string& server);

}  // namespace marrow::client

#endif  // MARROW_CLIENT_COMMAND_COMMANDS_H_
