// A file appears whole or not at all.
#ifndef MARROW_CLIENT_ATOMIC_FILE_H_
#define MARROW_CLIENT_ATOMIC_FILE_H_

#include <string>
#include <string_view>

#include "absl/status/status.h"

namespace marrow {

// Puts `bytes` at `path`, replacing a file that is there. Until the call
// succeeds the old file, or none, is what others see: the bytes go to a hidden
// file in the same folder, which is then renamed. A symbolic link stays one and
// what it points to is replaced; a replaced file keeps its permissions. A path
// that is no regular file, such as /dev/stdout or a named pipe, is written to
// directly.
//
// Errors name the path and what to do: NOT_FOUND (no such folder),
// PERMISSION_DENIED, RESOURCE_EXHAUSTED (disk full), FAILED_PRECONDITION (the
// path is a folder), otherwise UNKNOWN. After an error nothing new is left
// behind. Thread safe.
absl::Status WriteFileAtomically(const std::string& path,
                                 std::string_view bytes);

// Whether there is a folder for the file at `path`, and it may be written to,
// so that long work for it is not in vain. Errors are those of
// WriteFileAtomically().
absl::Status CheckWritable(const std::string& path);

}  // namespace marrow

#endif  // MARROW_CLIENT_ATOMIC_FILE_H_
