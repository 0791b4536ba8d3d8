// Lines of JSON between the program and its workers.
#include "experiments/evaluation.h"

#include <cmath>
#include <limits>

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

double to_number(const Json& json) {
  if (json.is_null()) return std::numeric_limits<double>::quiet_NaN();
  if (!json.is_string()) return json.get<double>();
  const double infinity = std::numeric_limits<double>::infinity();
  return json.get<std::string>() == "inf" ? infinity : -infinity;
}

std::vector<double> to_numbers(const Json& json) {
  std::vector<double> numbers;
  for (const Json& each : json) numbers.push_back(to_number(each));
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
  for (const Json& p : json.at("parameters"))
    scene.parameters.push_back({p.at("name"), to_number(p.at("min")), to_number(p.at("max")),
                                to_number(p.at("initial")), p.at("choices").get<std::vector<std::string>>(),
                                p.at("whole")});
  for (const Json& r : json.at("results"))
    scene.results.push_back({r.at("name"), to_number(r.at("min")), to_number(r.at("max")), r.at("cells")});
  scene.hash = json.at("hash");
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
    return WorkerSetup{setup.at("scene"), setup.at("duration"), setup.at("parameters").get<std::vector<std::string>>()};
  }
  const Json& evaluation = json->at("evaluate");
  return Evaluation{evaluation.at("number"), evaluation.at("seed"), to_numbers(evaluation.at("values"))};
} catch (const Json::exception&) {  // a field is missing or has another type
  return {};
}

std::optional<Answer> decode_answer(std::string_view line) try {
  const std::optional<Json> json = parse(line);
  if (!json) return {};
  if (json->contains("scene")) return to_scene(json->at("scene"));
  if (json->contains("fault")) return WorkerFault{json->at("fault")};
  const Json& outcome = json->at("outcome");
  return Outcome{outcome.at("number"), to_numbers(outcome.at("results")), outcome.at("hash"), outcome.at("error")};
} catch (const Json::exception&) {  // a field is missing or has another type
  return {};
}

}  // namespace limber::experiments
