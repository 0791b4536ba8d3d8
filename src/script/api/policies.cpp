// C API: policies.
#include <algorithm>
#include <span>

#include <fmt/format.h>

#include "base/text.h"
#include "script/api/script_context.h"

namespace limber::script::calls {

std::int32_t load_policy(void* c, const char* file, std::int32_t length) {
  ScriptContext& context = context_of(c);
  LoadedPolicies& policies = context.loaded.policies;
  const std::string name(text_of(file, length));
  if (policies.networks.size() >= LoadedPolicies::kMax)
    return context.reject(fmt::format("load_policy: a scene has at most {} policies", LoadedPolicies::kMax));
  const Result<std::string> path = context.sources->find(context.files, name);
  if (!path) return context.reject(fmt::format("load_policy: {}", path.error()));
  const Result<std::shared_ptr<const model::PolicyNetwork>> network = context.sources->policy(*path);
  if (!network) return context.reject(fmt::format("load_policy: {}", network.error()));
  policies.workspace.resize(std::max(policies.workspace.size(), (*network)->workspace()));
  context.answer.count = static_cast<std::int32_t>(policies.networks.size());
  context.answer.number[0] = static_cast<double>((*network)->inputs());
  context.answer.number[1] = static_cast<double>((*network)->outputs());
  context.answer.number[2] = static_cast<double>((*network)->hidden());
  policies.networks.push_back(*network);
  return kOk;
}

std::int32_t evaluate_policy(void* c, std::int32_t policy, const double* observations, float* hidden, double* actions) {
  ScriptContext& context = context_of(c);
  const auto index = static_cast<std::size_t>(policy);
  if (index >= context.loaded.policies.networks.size()) return kRemoved;
  const model::PolicyNetwork& network = *context.loaded.policies.networks[index];
  const Result<void> evaluated =
      network.evaluate(std::span(observations, network.inputs()), std::span(hidden, network.hidden()),
                       std::span(actions, network.outputs()), context.loaded.policies.workspace);
  return evaluated ? kOk : context.reject(evaluated.error());
}

}  // namespace limber::script::calls
