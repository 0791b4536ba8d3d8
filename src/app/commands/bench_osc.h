// Benchmarks of OSC over loopback: input, output and response times.
#pragma once

#include <nlohmann/json.hpp>

#include "app/commands/bench.h"

namespace limber {

/// Input through receiver, validator, decoder, queue and dispatch to properties: messages per second, single and in
/// bundles; and a burst of 10 000 datagrams through the kernel.
nlohmann::ordered_json bench_osc_in(const BenchOptions& options);

/// Response times: `/ping`, which the network thread answers, and a value that is set and read back at 60 ticks a
/// second.
nlohmann::ordered_json bench_osc_latency(const BenchOptions& options);

/// Time that a frame of 1000 bodies in three streams costs the network thread.
nlohmann::ordered_json bench_osc_out(const BenchOptions& options);

}  // namespace limber
