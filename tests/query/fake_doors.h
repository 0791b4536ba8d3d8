// Doors without the OSC room behind them: packets are text that a test can read.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "engine/show.h"
#include "query/doors.h"

namespace limber::query_test {

/// "address tags argument argument"; what is taken goes to `packets`.
inline QueryDoors fake_doors(std::vector<std::pair<Origin, std::string>>* packets = nullptr) {
  QueryDoors doors;
  doors.encode = [](const Message& message, std::string_view tags) {
    std::string text = message.address + " " + std::string(tags);
    for (const Arg& a : message.args) text += " " + (a.is_text() ? a.text : number_text(a.number));
    return text;
  };
  doors.take = [packets](const Origin& origin, std::string packet) {
    if (packets != nullptr) packets->emplace_back(origin, std::move(packet));
  };
  return doors;
}

}  // namespace limber::query_test
