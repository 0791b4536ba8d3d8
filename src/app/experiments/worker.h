// The worker process of experiments: reads evaluations from its standard input and writes their outcomes to its
// standard output, one line each (experiments/evaluation.h).
#pragma once

#include <string_view>

namespace limber::app {

/// The first argument of the program that makes it a worker. It is not for users, so no help lists it.
inline constexpr std::string_view kWorkerArgument = "--evaluations-from-input";

/// Works until its standard input ends. Returns the exit code. [main]
int run_worker();

}  // namespace limber::app
