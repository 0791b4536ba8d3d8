// Score of a golden scene: lines in its comments that give the number of engine passes, and the pass and content of
// each input.
//
//   --@ ticks 120                    number of passes of the engine (fewer simulated ticks if it is paused or rewinds)
//   --@ 30 send /push 0.5 left       a message; numbers, true, false, text
//   --@ 30 flood 500 /push 0.001     the same message 500 times
//   --@ 40 eval sim.gravity = vec3() a console line
//   --@ 50 replace "0.5" "0.7"       the scene's file is saved with another text, and reloaded
//   --@ 60 reload                    the scene's file is saved as it is, and reloaded
//   --@ 70 again 20                  rewinds 20 ticks; when they are played again, the hash must be the same
//   --@ 80 back 20                   rewinds 20 ticks
//   --@ take                         the run is recorded, and the take must replay to the same hash
//   --@ faults 2                     expected script errors, rejected values and health events
#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/message.h"
#include "base/text.h"

namespace limber::golden {

struct ScoreLine {
  int pass = 0;
  std::string verb;
  int count = 1;  ///< Of flood, again, back.
  Message message;
  std::string text;         ///< Of eval; the old text of replace.
  std::string replacement;  ///< The new text of replace.
};

struct Score {
  int ticks = 0;
  bool records_take = false;
  std::uint64_t faults = 0;
  std::vector<ScoreLine> lines;  ///< In the order of their passes.
};

inline std::string text_of_file(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  EXPECT_TRUE(in.good()) << file;
  return {std::istreambuf_iterator<char>(in), {}};
}

inline Message message_of(std::istream& in) {
  Message message;
  in >> message.address;
  for (std::string word; in >> word;) {
    if (const auto number = parse_number(word)) {
      message.args.push_back(Arg::of(*number));
    } else if (word == "true" || word == "false") {
      message.args.push_back(Arg::of(word == "true"));
    } else {
      message.args.push_back(Arg::of(std::string_view(word)));
    }
  }
  return message;
}

/// Parses `"a" "b"`. Returns false if there are not two quoted texts.
inline bool two_quoted(const std::string& text, std::string& first, std::string& second) {
  const std::vector<std::string_view> pieces = split(text, '"');
  if (pieces.size() != 5) return false;
  first = pieces[1];
  second = pieces[3];
  return true;
}

/// Parses a score line into `score`. Returns false on a syntax error.
inline bool read_line(const std::string& line, Score& score) {
  std::istringstream in(line.substr(4));
  std::string word;
  in >> word;
  if (word == "ticks") return static_cast<bool>(in >> score.ticks);
  if (word == "faults") return static_cast<bool>(in >> score.faults);
  if (word == "take") return score.records_take = true;
  const auto pass = parse_number(word);
  ScoreLine item;
  if (!pass || !(in >> item.verb)) return false;
  item.pass = static_cast<int>(*pass);
  if (!score.lines.empty() && score.lines.back().pass > item.pass) return false;
  std::string rest;
  if (item.verb == "flood" || item.verb == "again" || item.verb == "back") {
    if (!(in >> item.count)) return false;
  }
  if (item.verb == "send" || item.verb == "flood") {
    item.message = message_of(in);
  } else if (item.verb == "eval") {
    std::getline(in >> std::ws, item.text);
  } else if (item.verb == "replace") {
    std::getline(in, rest);
    if (!two_quoted(rest, item.text, item.replacement)) return false;
  } else if (item.verb != "reload" && item.verb != "again" && item.verb != "back") {
    return false;
  }
  score.lines.push_back(std::move(item));
  return true;
}

inline Score score_of(const std::string& scene) {
  Score score;
  std::istringstream in(scene);
  for (std::string line; std::getline(in, line);) {
    if (!line.starts_with("--@ ")) continue;
    const bool good = read_line(line, score);
    EXPECT_TRUE(good) << line;
  }
  EXPECT_GT(score.ticks, 0) << "a golden scene has a line '--@ ticks N'";
  return score;
}

}  // namespace limber::golden
