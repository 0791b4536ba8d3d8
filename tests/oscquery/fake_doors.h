// A QueryHost without the OSC module: packets are readable text.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "engine/show.h"
#include "net/oscquery/host.h"

namespace limber::oscquery::test {

/// Encodes messages as "address tags argument argument"; processed packets are appended to `packets`.
inline QueryHost fake_query_host(std::vector<std::pair<CommandOrigin, std::string>>* packets = nullptr) {
  QueryHost host;
  host.encode = [](const Message& message, std::string_view tags) {
    std::string text = message.address + " " + std::string(tags);
    for (const Arg& a : message.args) text += " " + (a.is_text() ? a.text : number_text(a.number));
    return text;
  };
  host.process = [packets](const CommandOrigin& origin, std::string packet) {
    if (packets != nullptr) packets->emplace_back(origin, std::move(packet));
  };
  return host;
}

}  // namespace limber::oscquery::test
