// `limber send ADDRESS ARGS…`: one OSC message from the command line, and what is answered.
#pragma once

#include <string>
#include <vector>

#include "base/message.h"

namespace limber {

struct SendCommand {
  std::string address;
  std::vector<std::string> words;  ///< The arguments as they were typed.
  std::string tags;                ///< OSC type tags of the arguments; empty: numbers are f, booleans i, text s.
  std::string to = "127.0.0.1:9003";
  double wait = 1;  ///< s to wait for the answers; 0: none are waited for.
};

/// What a word means: a number, true or false, else text; in quotes of its own ("'1'") it is text whatever it says.
Arg arg_of(const std::string& word);

/// Answers go to stdout, refusals to stderr. The exit code: 1 when it was refused, 3 when nobody answers. [main]
int send_command(const SendCommand& command);

}  // namespace limber
