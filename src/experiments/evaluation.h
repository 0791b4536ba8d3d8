// Evaluation: a run of the scene with given values of its parameters and a seed. Messages between the program and its
// workers are lines of JSON. [any]
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "base/result.h"
#include "experiments/axis.h"

namespace limber::experiments {

/// The part that all evaluations of an experiment share.
struct WorkerSetup {
  std::string scene;
  double duration = 0;                  ///< s
  std::vector<std::string> parameters;  ///< Names of the parameters that evaluations set.
};

struct Evaluation {
  std::uint64_t number = 0;
  std::uint64_t seed = 0;
  std::vector<double> values;  ///< In the order of WorkerSetup::parameters.
};

struct Outcome {
  std::uint64_t number = 0;
  std::vector<double> results;  ///< In the order of SceneInfo::results; NaN: no value.
  std::uint64_t hash = 0;       ///< State hash at the end.
  std::string error;            ///< Reason of the failure; empty: it succeeded.
};

/// A result that the scene declares.
struct ResultInfo {
  std::string name;
  double min = 0;
  double max = 0;
  int cells = 0;  ///< 0: it has no range.

  bool operator==(const ResultInfo&) const = default;
};

/// The parameters and results that a scene declares.
struct SceneInfo {
  std::vector<ParameterInfo> parameters;
  std::vector<ResultInfo> results;
  std::uint64_t hash = 0;  ///< State hash at the beginning, which shows whether two scenes are the same.

  bool operator==(const SceneInfo&) const = default;
};

/// A failed setup, such as a scene with an error.
struct WorkerFault {
  std::string text;
};
using Request = std::variant<WorkerSetup, Evaluation>;
using Answer = std::variant<SceneInfo, Outcome, WorkerFault>;

/// Return one line of JSON without a line feed; numbers keep all their bits.
std::string encode(const Request& request);
std::string encode(const Answer& answer);
/// Return nullopt if the line is not one of these messages.
std::optional<Request> decode_request(std::string_view line);
std::optional<Answer> decode_answer(std::string_view line);

}  // namespace limber::experiments
