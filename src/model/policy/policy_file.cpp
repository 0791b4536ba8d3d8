// The formats of files with policies.
#include "model/policy/policy_file.h"

#include <fmt/format.h>

#include "base/hash.h"
#include "base/text.h"
#include "model/policy/formats.h"

namespace limber::model {

namespace {

bool ends_with_in_any_case(std::string_view text, std::string_view end) {
  return text.size() >= end.size() && same_in_any_case(text.substr(text.size() - end.size()), end);
}

Result<std::shared_ptr<PolicyNetwork>> read_policy(std::string_view bytes, std::string_view file) {
  if (bytes.size() > PolicyNetwork::kMaxBytes)
    return Error{fmt::format("has {} bytes; the maximum is {}. Train a smaller network.", bytes.size(),
                             PolicyNetwork::kMaxBytes)};
  if (ends_with_in_any_case(file, ".safetensors")) return policy::read_safetensors(bytes);
  if (ends_with_in_any_case(file, ".onnx")) return policy::read_onnx(bytes);
  return Error{"a policy is a .safetensors or .onnx file. Export it in one of these formats."};
}

}  // namespace

Result<std::shared_ptr<const PolicyNetwork>> parse_policy(std::string_view bytes, const std::string& file) {
  Result<std::shared_ptr<PolicyNetwork>> network = read_policy(bytes, file);
  if (!network) return Error{fmt::format("{}: {}", file, network.error())};
  (*network)->content_hash = hash_bytes(bytes);
  return std::shared_ptr<const PolicyNetwork>(std::move(*network));
}

}  // namespace limber::model
