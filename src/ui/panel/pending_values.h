// PendingValues: values set in the panel that are not yet contained in a value snapshot. The panel displays them until
// a snapshot arrives that was taken after the last set().
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>

namespace limber::panel {

class PendingValues {
 public:
  using Values = std::array<double, 4>;

  /// `request`: the request number that EngineLink::request_value_snapshot returned after the value was sent.
  void set(const std::string& path, const Values& values, std::uint64_t request) { values_[path] = {values, request}; }
  /// Removes the values contained in a snapshot that answers requests up to this number.
  void remove_confirmed(std::uint64_t request) {
    std::erase_if(values_, [&](const auto& entry) { return entry.second.request <= request; });
  }
  const Values* find(const std::string& path) const {
    const auto found = values_.find(path);
    return found == values_.end() ? nullptr : &found->second.values;
  }

 private:
  struct PendingValue {
    Values values{};
    std::uint64_t request = 0;
  };
  std::unordered_map<std::string, PendingValue> values_;
};

}  // namespace limber::panel
