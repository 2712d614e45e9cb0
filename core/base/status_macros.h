// Early return on a failed absl::Status or absl::StatusOr.
#ifndef MARROW_CORE_BASE_STATUS_MACROS_H_
#define MARROW_CORE_BASE_STATUS_MACROS_H_

#include <utility>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

// Returns from the enclosing function when `expr` is not OK.
#define MARROW_RETURN_IF_ERROR(expr)                              \
  do {                                                            \
    if (absl::Status marrow_status = (expr); !marrow_status.ok()) \
      return marrow_status;                                       \
  } while (false)

#define MARROW_CONCAT_INNER(a, b) a##b
#define MARROW_CONCAT(a, b) MARROW_CONCAT_INNER(a, b)

// Evaluates a StatusOr, and either assigns its value to `lhs` (which may
// declare a variable) or returns its status.
#define MARROW_ASSIGN_OR_RETURN(lhs, expr)                                  \
  MARROW_ASSIGN_OR_RETURN_INNER(MARROW_CONCAT(marrow_status_or_, __LINE__), \
                                lhs, expr)
#define MARROW_ASSIGN_OR_RETURN_INNER(tmp, lhs, expr) \
  auto tmp = (expr);                                  \
  if (!tmp.ok()) return std::move(tmp).status();      \
  lhs = std::move(tmp).value()

#endif  // MARROW_CORE_BASE_STATUS_MACROS_H_
