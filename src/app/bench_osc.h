// OSC on this machine: messages in, frames out, and how long an answer takes. All on loopback.
#pragma once

#include <nlohmann/json.hpp>

#include "app/bench.h"

namespace limber {

/// Through receive, validator, decoder, inbox and dispatch into rows: what the processor needs for a message, alone and
/// in bundles; and a burst of 10 000 datagrams through the kernel.
nlohmann::ordered_json bench_osc_in(const BenchOptions& options);

/// From question to answer: `/ping`, which the network thread answers, and a value that is set and read back at 60
/// ticks a second.
nlohmann::ordered_json bench_osc_latency(const BenchOptions& options);

/// What a frame of 1000 bodies in three streams costs the network thread.
nlohmann::ordered_json bench_osc_out(const BenchOptions& options);

}  // namespace limber
