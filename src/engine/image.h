// Image: a finished copy of the whole tree with every value, made when somebody outside asks; and what hands outside
// have set lately, so that nobody is told what it has said itself.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/message.h"
#include "engine/snapshot.h"
#include "params/tree.h"

namespace limber {

/// A value that a hand set which follows changes (Origin::follows).
struct WriteNote {
  std::uint64_t number = 0;  ///< Counts from 1.
  Origin origin;
  NodeId node;
  const Row* row = nullptr;
  std::array<double, 4> values{};  ///< As they were taken.
  bool clamped = false;            ///< They are not what was sent.
};

/// A row's value in an image: numbers, or a text's words. Valid as long as the image.
struct RowValue {
  const double* numbers = nullptr;
  std::string_view text;
};

struct Image {
  std::uint64_t number = 0;  ///< Counts from 1 over the engine's life.
  std::uint64_t asks = 0;    ///< It answers EngineLink::ask_image up to this one.
  std::shared_ptr<const Tree> tree;
  std::shared_ptr<const Snapshot> snapshot;  ///< Of the same moment: time, live values.
  std::vector<double> kept;
  std::vector<double> views;
  std::vector<std::string> texts;
  std::vector<WriteNote> notes;  ///< Each stays for so many images, for readers that leave some out.

  /// Of an action: nothing.
  RowValue value(const TreeNumbers& where) const {
    switch (where.block) {
      case TreeNumbers::Block::kept:
        return {kept.data() + where.at, {}};
      case TreeNumbers::Block::live:
        return {snapshot->live.data() + where.at, {}};
      case TreeNumbers::Block::views:
        return {views.data() + where.at, {}};
      case TreeNumbers::Block::texts:
        return {nullptr, texts[where.at]};
      case TreeNumbers::Block::none:
        break;
    }
    return {};
  }
};

}  // namespace limber
