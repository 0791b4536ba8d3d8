// Reads files of policies: safetensors and ONNX. [any]
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "base/result.h"
#include "model/policy/policy_network.h"

namespace limber::model {

/// Reads a policy in the format that the name of its file ends with: .safetensors or .onnx. Errors name the file, the
/// tensor or node, and a fix.
Result<std::shared_ptr<const PolicyNetwork>> parse_policy(std::string_view bytes, const std::string& file);

}  // namespace limber::model
