// A dedicated writer for streams, because a thousand bodies need half a megabyte sixty times a second.
#include "net/osc/stream_frame.h"

#include <algorithm>
#include <bit>
#include <string_view>

#include "base/check.h"
#include "base/text.h"
#include "net/osc/packets/wire.h"

namespace limber::osc {

namespace {

constexpr std::size_t kDefaultBundle = 1472;     // payload of an Ethernet frame
constexpr std::size_t kMaxUnbundledBodies = 20;  // bodies, if no bundle size is configured

// Appends text with its terminating NULs up to a multiple of 4.
void append_text(std::vector<char>& bytes, std::string_view text) {
  const std::size_t end = bytes.size() + padded(text.size());
  bytes.insert(bytes.end(), text.begin(), text.end());
  bytes.resize(end, 0);
}

bool is_streamed(const engine::BodyEntry& body, const StreamTarget& config) {
  return !body.joint_offsets.empty() && pattern_match(config.bodies, body.name);
}

// Writes W numbers of each joint. W is a template parameter for speed, because a thousand bodies have 170 000 numbers.
// Returns false if a joint's block is outside the snapshot.
template <std::uint32_t W>
bool write_numbers(char* to, const std::vector<std::uint32_t>& joints, std::uint32_t offset,
                   const std::vector<double>& transient) {
  for (const std::uint32_t joint : joints) {
    const std::size_t from = std::size_t{joint} + offset;
    if (from + W > transient.size()) return false;
    for (std::uint32_t k = 0; k < W; k++, to += 4) {
      store_u32(to, std::bit_cast<std::uint32_t>(static_cast<float>(transient[from + k])));
    }
  }
  return true;
}

}  // namespace

void StreamFrame::lay_out(const std::shared_ptr<const engine::BodyList>& body_list, const StreamTarget& config) {
  if (body_list == body_list_ && config == config_) return;
  body_list_ = body_list;
  config_ = config;
  bytes_.clear();
  datagrams_.clear();
  numbers_.clear();
  too_large_.clear();
  if (!body_list) return;

  std::vector<std::uint32_t> selected;
  for (std::uint32_t i = 0; i < body_list->bodies.size(); i++) {
    if (is_streamed(body_list->bodies[i], config)) selected.push_back(i);
  }
  const std::size_t automatic = selected.size() > kMaxUnbundledBodies ? kDefaultBundle : 0;
  const std::size_t limit = config.bundle < 0 ? automatic : static_cast<std::size_t>(config.bundle);

  begin_ = first_numbers_ = 0;
  open_.clear();
  const auto add_stream = [&](bool wanted, const Stream& stream) {
    for (const std::uint32_t i : selected) {
      if (wanted) add_message(stream, body_list->bodies[i], i, limit);
    }
  };
  add_stream(config.pos, {"/physics/joint/pos", offsets_.joint_position, 3});
  add_stream(config.rot, {"/physics/joint/rot", offsets_.joint_rotation, 4});
  add_stream(config.relrot, {"/physics/joint/relrot", offsets_.joint_relrot, 3});
  add_stream(config.relpos, {"/physics/joint/relpos", offsets_.joint_offsets, 3});
  end_datagram();
  // order by body, because the values of a joint are adjacent in memory
  std::ranges::stable_sort(numbers_, {}, &NumberBlock::body);
}

void StreamFrame::add_message(const Stream& stream, const engine::BodyEntry& body, std::uint32_t index,
                              std::size_t limit) {
  const std::string_view address = stream.address;
  const std::size_t count = body.joint_offsets.size() * stream.width;
  const std::size_t size = padded(address.size()) + padded(2 + count) + padded(body.name.size()) + 4 * count;
  if (size > kMaxPacketSize) {
    if (too_large_.empty() || too_large_.back() != body.name) too_large_.push_back(body.name);
    return;
  }
  // in a bundle each message is preceded by its size; a single message needs neither size nor header
  const std::size_t so_far = bytes_.size() - begin_ + 4 * open_.size();
  if (!open_.empty() && kBundleHeader + so_far + 4 + size > limit) end_datagram();
  append_text(bytes_, address);
  append_text(bytes_, ",s" + std::string(count, 'f'));
  append_text(bytes_, body.name);
  numbers_.push_back({static_cast<std::uint32_t>(bytes_.size()), index, stream.offset, stream.width});
  bytes_.resize(bytes_.size() + 4 * count);
  open_.push_back(static_cast<std::uint32_t>(size));
}

// Completes the open messages as one datagram: a bundle if there are several.
void StreamFrame::end_datagram() {
  if (open_.empty()) return;
  if (open_.size() > 1) {
    std::vector<char> bundle;
    append_text(bundle, "#bundle");
    bundle.resize(kBundleHeader);
    bundle[15] = 1;  // time tag: immediately
    std::size_t from = begin_;
    for (std::size_t i = 0; i < open_.size(); i++) {
      bundle.resize(bundle.size() + 4);
      store_u32(bundle.data() + bundle.size() - 4, open_[i]);
      NumberBlock& numbers = numbers_[first_numbers_ + i];
      numbers.position = static_cast<std::uint32_t>(begin_ + bundle.size() + (numbers.position - from));
      bundle.insert(bundle.end(), bytes_.begin() + static_cast<std::ptrdiff_t>(from),
                    bytes_.begin() + static_cast<std::ptrdiff_t>(from + open_[i]));
      from += open_[i];
    }
    bytes_.resize(begin_);
    bytes_.insert(bytes_.end(), bundle.begin(), bundle.end());
  }
  datagrams_.push_back(static_cast<std::uint32_t>(bytes_.size() - begin_));
  begin_ = bytes_.size();
  first_numbers_ = numbers_.size();
  open_.clear();
}

void StreamFrame::fill(const engine::Snapshot& snapshot) {
  for (const NumberBlock& n : numbers_) {
    const std::vector<std::uint32_t>& joints = body_list_->bodies[n.body].joint_offsets;
    char* to = bytes_.data() + n.position;
    const bool inside = n.width == 3 ? write_numbers<3>(to, joints, n.offset, snapshot.transient)
                                     : write_numbers<4>(to, joints, n.offset, snapshot.transient);
    LIMBER_CHECK(inside);
  }
}

}  // namespace limber::osc
