// The reader of BVH files: HIERARCHY with its joints, then MOTION with its frames.
#include <algorithm>
#include <cmath>
#include <optional>
#include <unordered_set>

#include <fmt/format.h>

#include "base/hash.h"
#include "base/text.h"
#include "model/mocap/bvh.h"

namespace limber::model {

namespace {

constexpr std::size_t kMaxChannelValues = 40'000'000;  // of all frames: 160 MB
constexpr double kMinFrameTime = 1e-4;                 // s
constexpr double kMaxFrameTime = 10;

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\v' || c == '\f'; }

std::optional<BvhChannel> bvh_channel_named(std::string_view word) {
  constexpr std::array<std::string_view, 6> kNames{"xposition", "yposition", "zposition",
                                                   "xrotation", "yrotation", "zrotation"};
  for (std::size_t i = 0; i < kNames.size(); i++) {
    if (same_in_any_case(word, kNames[i])) return static_cast<BvhChannel>(i);
  }
  return std::nullopt;
}

// Reads words, and counts lines for error messages.
class BvhWords {
 public:
  explicit BvhWords(std::string_view text) : text_(text) {}

  /// The next word; empty at the end.
  std::string_view next() {
    skip_blank();
    const std::size_t start = at_;
    while (at_ < text_.size() && !is_blank(text_[at_])) at_++;
    return text_.substr(start, at_ - start);
  }
  /// The rest of the line, without blanks around it and without a brace at its end.
  std::string_view rest_of_line() {
    while (at_ < text_.size() && text_[at_] != '\n' && is_blank(text_[at_])) at_++;
    const std::size_t start = at_;
    while (at_ < text_.size() && text_[at_] != '\n' && text_[at_] != '{') at_++;
    std::string_view rest = text_.substr(start, at_ - start);
    while (!rest.empty() && is_blank(rest.back())) rest.remove_suffix(1);
    return rest;
  }
  bool at_end() {
    skip_blank();
    return at_ == text_.size();
  }
  std::size_t line() const { return line_; }

 private:
  void skip_blank() {
    for (; at_ < text_.size() && is_blank(text_[at_]); at_++) line_ += text_[at_] == '\n' ? 1 : 0;
  }

  std::string_view text_;
  std::size_t at_ = 0;
  std::size_t line_ = 1;
};

class BvhReader {
 public:
  BvhReader(std::string_view text, std::string file) : words_(text) { clip_.file = std::move(file); }

  Result<std::shared_ptr<const BvhClip>> read(std::string_view text) {
    clip_.content_hash = hash_bytes(text);
    if (text.size() > BvhClip::kMaxBytes)
      return fault(fmt::format("has {} bytes; at most {} are read", text.size(), BvhClip::kMaxBytes));
    if (Result<void> done = read_hierarchy(); !done) return Error{done.error()};
    if (Result<void> done = read_motion(); !done) return Error{done.error()};
    return std::shared_ptr<const BvhClip>(std::make_shared<BvhClip>(std::move(clip_)));
  }

 private:
  Error fault(std::string_view problem) const {
    return Error{fmt::format("{}, line {}: {}", printable(clip_.file), words_.line(), problem)};
  }
  Result<void> expect(std::string_view wanted) {
    const std::string_view word = words_.next();
    if (same_in_any_case(word, wanted)) return {};
    return fault(fmt::format("expected {}, got {}", wanted, text_or_end(word)));
  }
  static std::string text_or_end(std::string_view word) {
    return word.empty() ? "the end of the file" : fmt::format("'{}'", printable(shortened(word, 40)));
  }
  Result<double> number(std::string_view what) {
    const std::string_view word = words_.next();
    const std::optional<double> value = parse_number(word);
    if (!value || !std::isfinite(*value))
      return fault(fmt::format("{} must be a number, got {}", what, text_or_end(word)));
    if (std::abs(*value) > BvhClip::kMaxValue)
      return fault(fmt::format("{} must be {} .. {}, got {}", what, -BvhClip::kMaxValue, BvhClip::kMaxValue, *value));
    return *value;
  }

  Result<void> read_offset(Vec3& out) {
    for (int axis = 0; axis < 3; axis++) {
      const Result<double> value = number("an OFFSET");
      if (!value) return Error{value.error()};
      out[axis] = *value;
    }
    return {};
  }

  Result<void> read_channels(BvhJoint& joint) {
    const Result<double> count = number("the number of CHANNELS");
    if (!count) return Error{count.error()};
    if (*count < 0 || *count > 6 || *count != std::floor(*count))
      return fault(fmt::format("a joint has 0 .. 6 CHANNELS, got {}", *count));
    joint.first_channel = clip_.channels;
    for (int i = 0; i < static_cast<int>(*count); i++) {
      const std::string_view word = words_.next();
      const std::optional<BvhChannel> channel = bvh_channel_named(word);
      if (!channel)
        return fault(fmt::format("expected a channel such as Xposition or Zrotation, got {}", text_or_end(word)));
      const auto end = joint.channels.begin() + static_cast<std::ptrdiff_t>(joint.channel_count);
      if (std::find(joint.channels.begin(), end, *channel) != end)
        return fault(fmt::format("joint '{}' has the channel {} twice", joint.name, word));
      joint.channels[joint.channel_count++] = *channel;
    }
    clip_.channels += joint.channel_count;
    return {};
  }

  Result<void> open_joint(int parent) {
    if (clip_.joints.size() == BvhClip::kMaxJoints)
      return fault(fmt::format("has more than {} joints", BvhClip::kMaxJoints));
    BvhJoint joint;
    joint.name = std::string(words_.rest_of_line());
    joint.parent = parent;
    if (const auto wrong = name_error(joint.name)) return fault(fmt::format("joint: {}", *wrong));
    if (!names_.insert(joint.name).second)
      return fault(fmt::format("there is a joint '{}' already; rename one of them", joint.name));
    clip_.joints.push_back(std::move(joint));
    open_.push_back(static_cast<int>(clip_.joints.size()) - 1);
    return expect("{");
  }

  Result<void> read_end_site() {
    if (Result<void> word = expect("Site"); !word) return word;
    (void)words_.rest_of_line();  // some programs give it a name
    if (Result<void> word = expect("{"); !word) return word;
    if (Result<void> word = expect("OFFSET"); !word) return word;
    Vec3 unused;
    if (Result<void> offset = read_offset(unused); !offset) return offset;
    return expect("}");
  }

  // One entry of an open joint.
  Result<void> read_entry(std::string_view word) {
    BvhJoint& joint = clip_.joints[static_cast<std::size_t>(open_.back())];
    if (same_in_any_case(word, "OFFSET")) return read_offset(joint.offset);
    if (same_in_any_case(word, "CHANNELS")) {
      if (joint.channel_count > 0) return fault(fmt::format("joint '{}' has CHANNELS twice", joint.name));
      return read_channels(joint);
    }
    if (same_in_any_case(word, "JOINT")) return open_joint(open_.back());
    if (same_in_any_case(word, "End")) return read_end_site();
    if (word == "}") {
      open_.pop_back();
      return {};
    }
    return fault(fmt::format("expected OFFSET, CHANNELS, JOINT, End Site or }}, got {}", text_or_end(word)));
  }

  Result<void> read_hierarchy() {
    if (Result<void> word = expect("HIERARCHY"); !word) return word;
    while (true) {
      const std::string_view word = words_.next();
      if (open_.empty() && same_in_any_case(word, "MOTION")) break;
      Result<void> done;
      if (!open_.empty()) {
        done = read_entry(word);
      } else if (same_in_any_case(word, "ROOT")) {
        done = open_joint(-1);
      } else {
        done = fault(fmt::format("expected ROOT or MOTION, got {}", text_or_end(word)));
      }
      if (!done) return done;
    }
    if (clip_.joints.empty()) return fault("has no joint: a ROOT is missing before MOTION");
    if (clip_.channels == 0) return fault("no joint has CHANNELS, so nothing moves");
    return {};
  }

  Result<void> read_motion() {
    if (Result<void> word = expect("Frames:"); !word) return word;
    const std::string_view count_word = words_.next();
    const std::optional<double> count = parse_number(count_word);
    const double most =
        std::min(static_cast<double>(BvhClip::kMaxFrames),
                 std::floor(static_cast<double>(kMaxChannelValues) / static_cast<double>(clip_.channels)));
    if (!count || !(*count >= 1) || *count > most || *count != std::floor(*count))
      return fault(fmt::format("Frames must be 1 .. {} with {} channels, got {}", most, clip_.channels,
                               text_or_end(count_word)));
    if (Result<void> word = expect("Frame"); !word) return word;
    if (Result<void> word = expect("Time:"); !word) return word;
    const Result<double> frame_time = number("Frame Time");
    if (!frame_time) return Error{frame_time.error()};
    if (*frame_time < kMinFrameTime || *frame_time > kMaxFrameTime)
      return fault(fmt::format("Frame Time must be {} .. {} s, got {}", kMinFrameTime, kMaxFrameTime, *frame_time));
    clip_.frame_time = *frame_time;
    clip_.frames = static_cast<std::size_t>(*count);
    for (std::size_t i = 0; i < clip_.frames * clip_.channels; i++) {
      if (words_.at_end())
        return fault(
            fmt::format("ends in frame {} of {}; the file is incomplete", i / clip_.channels + 1, clip_.frames));
      const Result<double> value = number("a channel's value");
      if (!value) return Error{value.error()};
      clip_.values.push_back(static_cast<float>(*value));
    }
    if (!words_.at_end()) return fault(fmt::format("has more values than {} frames", clip_.frames));
    return {};
  }

  BvhWords words_;
  BvhClip clip_;
  std::vector<int> open_;  // indices of the joints that are open
  std::unordered_set<std::string> names_;
};

}  // namespace

Result<std::shared_ptr<const BvhClip>> parse_bvh(std::string_view text, std::string file) {
  return BvhReader(text, std::move(file)).read(text);
}

}  // namespace limber::model
