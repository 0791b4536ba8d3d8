// `limber send ADDRESS ARGS…`: sends one OSC message and prints the replies.
#pragma once

#include <string>
#include <vector>

#include "base/message.h"

namespace limber {

/// Arguments of `send`.
struct SendCommand {
  std::string address;
  std::vector<std::string> words;  ///< The arguments as typed.
  std::string tags;                ///< OSC type tags of the arguments; empty: numbers are f, booleans i, text s.
  std::string to = "127.0.0.1:9003";
  double wait = 1;  ///< Time to wait for replies, s; 0: don't wait.
};

/// Converts a word to an argument: a number, true or false, else text. A word in its own quotes ("'1'") is always text.
Arg parse_arg(const std::string& word);

/// Prints replies to stdout and errors to stderr. Returns the exit code: 1 if the message was rejected, 3 without a
/// reply. [main]
int send_command(const SendCommand& command);

}  // namespace limber
