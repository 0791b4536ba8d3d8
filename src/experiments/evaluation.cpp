// Lines of JSON between the program and its workers.
#include "experiments/evaluation.h"

#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/text.h"

namespace limber::experiments {

namespace {

using Json = nlohmann::json;

// JSON has no NaN and no infinity
Json number(double value) {
  if (std::isfinite(value)) return value;
  return std::isnan(value) ? Json() : Json(value > 0 ? "inf" : "-inf");
}

// The field has another type or is out of range.
struct WrongField {};

double to_number(const Json& json) {
  if (json.is_number()) return json.get<double>();
  if (json.is_null()) return std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  if (json == "inf") return infinity;
  if (json == "-inf") return -infinity;
  throw WrongField{};
}

double to_finite(const Json& json) {
  if (!json.is_number()) throw WrongField{};
  return json.get<double>();
}

// nlohmann's own conversions accept booleans and fractions, and wrap numbers that are too large.
template <class Integer = std::uint64_t>
Integer to_whole(const Json& json) {
  if (!json.is_number_unsigned() || !std::in_range<Integer>(json.get<std::uint64_t>())) throw WrongField{};
  return json.get<Integer>();
}

const Json::array_t& to_list(const Json& json) { return json.get_ref<const Json::array_t&>(); }

std::vector<double> to_numbers(const Json& json) {
  std::vector<double> numbers;
  for (const Json& each : to_list(json)) numbers.push_back(to_number(each));
  return numbers;
}

Json numbers(const std::vector<double>& values) {
  Json list = Json::array();
  for (const double value : values) list.push_back(number(value));
  return list;
}

std::string dump(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

Json to_json(const SceneInfo& scene) {
  Json parameters = Json::array();
  for (const ParameterInfo& p : scene.parameters)
    parameters.push_back({{"name", p.name},
                          {"min", number(p.min)},
                          {"max", number(p.max)},
                          {"initial", number(p.initial)},
                          {"choices", p.choices},
                          {"whole", p.whole}});
  Json results = Json::array();
  for (const ResultInfo& r : scene.results)
    results.push_back({{"name", r.name}, {"min", number(r.min)}, {"max", number(r.max)}, {"cells", r.cells}});
  return {{"parameters", parameters}, {"results", results}, {"hash", scene.hash}};
}

SceneInfo to_scene(const Json& json) {
  SceneInfo scene;
  for (const Json& p : to_list(json.at("parameters")))
    scene.parameters.push_back({p.at("name"), to_number(p.at("min")), to_number(p.at("max")),
                                to_number(p.at("initial")), p.at("choices").get<std::vector<std::string>>(),
                                p.at("whole")});
  for (const Json& r : to_list(json.at("results")))
    scene.results.push_back(
        {r.at("name"), to_number(r.at("min")), to_number(r.at("max")), to_whole<int>(r.at("cells"))});
  scene.hash = to_whole(json.at("hash"));
  return scene;
}

std::optional<Json> parse(std::string_view line) {
  Json json = Json::parse(line, nullptr, false);
  if (json.is_discarded() || !json.is_object()) return {};
  return json;
}

}  // namespace

std::string encode(const Request& request) {
  if (const auto* setup = std::get_if<WorkerSetup>(&request))
    return dump(
        {{"setup", {{"scene", setup->scene}, {"duration", setup->duration}, {"parameters", setup->parameters}}}});
  const auto& evaluation = std::get<Evaluation>(request);
  return dump({{"evaluate",
                {{"number", evaluation.number}, {"seed", evaluation.seed}, {"values", numbers(evaluation.values)}}}});
}

std::string encode(const Answer& answer) {
  if (const auto* scene = std::get_if<SceneInfo>(&answer)) return dump({{"scene", to_json(*scene)}});
  if (const auto* fault = std::get_if<WorkerFault>(&answer)) return dump({{"fault", fault->text}});
  const auto& outcome = std::get<Outcome>(answer);
  return dump({{"outcome",
                {{"number", outcome.number},
                 {"results", numbers(outcome.results)},
                 {"hash", outcome.hash},
                 {"error", outcome.error}}}});
}

std::optional<Request> decode_request(std::string_view line) try {
  const std::optional<Json> json = parse(line);
  if (!json) return {};
  if (json->contains("setup")) {
    const Json& setup = json->at("setup");
    return WorkerSetup{setup.at("scene"), to_finite(setup.at("duration")),
                       setup.at("parameters").get<std::vector<std::string>>()};
  }
  const Json& evaluation = json->at("evaluate");
  return Evaluation{to_whole(evaluation.at("number")), to_whole(evaluation.at("seed")),
                    to_numbers(evaluation.at("values"))};
} catch (const Json::exception&) {  // a field is missing or has another type
  return {};
} catch (const WrongField&) {
  return {};
}

std::optional<Answer> decode_answer(std::string_view line) try {
  const std::optional<Json> json = parse(line);
  if (!json) return {};
  if (json->contains("scene")) return to_scene(json->at("scene"));
  if (json->contains("fault")) return WorkerFault{json->at("fault")};
  const Json& outcome = json->at("outcome");
  return Outcome{to_whole(outcome.at("number")), to_numbers(outcome.at("results")), to_whole(outcome.at("hash")),
                 outcome.at("error")};
} catch (const Json::exception&) {  // a field is missing or has another type
  return {};
} catch (const WrongField&) {
  return {};
}

}  // namespace limber::experiments
