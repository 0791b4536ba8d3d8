// HandValues: what a hand has set and the simulation has not told back yet. While a hand holds a slider, the panel
// shows the hand; after that, until an image comes that was made behind the hand's last word.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>

namespace limber {

class HandValues {
 public:
  using Values = std::array<double, 4>;

  /// `ask`: what EngineLink::ask_image gave after the value was sent.
  void set(const std::string& path, const Values& values, std::uint64_t ask) { values_[path] = {values, ask}; }
  /// An image that answers asks up to this one has come.
  void heard(std::uint64_t asks) {
    std::erase_if(values_, [&](const auto& entry) { return entry.second.ask <= asks; });
  }
  const Values* find(const std::string& path) const {
    const auto found = values_.find(path);
    return found == values_.end() ? nullptr : &found->second.values;
  }

 private:
  struct Set {
    Values values{};
    std::uint64_t ask = 0;
  };
  std::unordered_map<std::string, Set> values_;
};

}  // namespace limber
