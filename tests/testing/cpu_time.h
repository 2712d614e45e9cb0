// What a computation costs, on a machine that may be busy.
#ifndef MARROW_TESTS_TESTING_CPU_TIME_H_
#define MARROW_TESTS_TESTING_CPU_TIME_H_

#include <time.h>

namespace marrow {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

// Seconds of a processor that this process has used, all threads together:
// other processes do not make them more.
inline double CpuSeconds() {
  timespec now;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * now.tv_nsec;
}

// A limit of seconds, wider where sanitizers slow everything down.
inline double Allowed(double seconds) {
  return kSanitized ? 10 * seconds : seconds;
}

}  // namespace marrow

#endif  // MARROW_TESTS_TESTING_CPU_TIME_H_
