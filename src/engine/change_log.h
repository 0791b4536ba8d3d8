// ChangeLog: who set which value lately, from what to what. The simulation writes, monitors read. [any]
#pragma once

#include <cstdint>
#include <deque>
#include <mutex>
#include <string>
#include <vector>

namespace limber {

struct ChangeLine {
  std::uint64_t number = 0;  ///< Counts from 1.
  double time = 0;           ///< system::clock_seconds(), when it was set last.
  std::string who;           ///< As sender_text() names a hand.
  std::string path;
  std::string from, to;       ///< As value_text() has them; of a hand that goes on, the first and the last.
  std::uint64_t version = 0;  ///< Counts what was added or renewed.
};

class ChangeLog {
 public:
  static constexpr std::size_t kMostLines = 4096;

  /// The oldest line goes when there are too many. The answer: its number.
  std::uint64_t add(ChangeLine line);
  /// The hand went on: it is another value now. False: the line has gone.
  bool renew(std::uint64_t number, double time, std::string to);
  /// Those that were added or renewed after that version, in that order.
  std::vector<ChangeLine> after(std::uint64_t version) const;
  /// Those that were set at that time or later, the oldest first.
  std::vector<ChangeLine> since(double time) const;

 private:
  mutable std::mutex mutex_;
  std::deque<ChangeLine> lines_;
  std::uint64_t newest_ = 0;
  std::uint64_t versions_ = 0;
};

}  // namespace limber
