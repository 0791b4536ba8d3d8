// The streams' own writer: a thousand bodies need half a million bytes sixty times a second.
#include "osc/stream_frame.h"

#include <algorithm>
#include <bit>
#include <string_view>

#include "base/check.h"
#include "base/text.h"
#include "osc/wire.h"

namespace limber {

namespace {

constexpr std::size_t kDefaultBundle = 1472;  // what an Ethernet frame holds
constexpr std::size_t kMostUnbundled = 20;    // bodies, where nothing else is wished

// appends text with its NULs up to a multiple of 4
void append_text(std::vector<char>& bytes, std::string_view text) {
  const std::size_t end = bytes.size() + padded(text.size());
  bytes.insert(bytes.end(), text.begin(), text.end());
  bytes.resize(end, 0);
}

bool streamed(const RosterBody& body, const StreamTarget& wish) {
  return !body.joints.empty() && pattern_match(wish.bodies, body.name);
}

// W numbers of each joint; the width is known to the compiler, because a thousand bodies have 170 000 of them. False
// when a joint's block is not in the snapshot
template <std::uint32_t W>
bool write_numbers(char* to, const std::vector<std::uint32_t>& joints, std::uint32_t offset,
                   const std::vector<double>& live) {
  for (const std::uint32_t joint : joints) {
    const std::size_t from = std::size_t{joint} + offset;
    if (from + W > live.size()) return false;
    for (std::uint32_t k = 0; k < W; k++, to += 4) {
      store_u32(to, std::bit_cast<std::uint32_t>(static_cast<float>(live[from + k])));
    }
  }
  return true;
}

}  // namespace

void StreamFrame::lay_out(const std::shared_ptr<const Roster>& roster, const StreamTarget& wish) {
  if (roster == roster_ && wish == wish_) return;
  roster_ = roster;
  wish_ = wish;
  bytes_.clear();
  datagrams_.clear();
  numbers_.clear();
  too_large_.clear();
  if (!roster) return;

  std::vector<std::uint32_t> chosen;
  for (std::uint32_t i = 0; i < roster->bodies.size(); i++) {
    if (streamed(roster->bodies[i], wish)) chosen.push_back(i);
  }
  const std::size_t automatic = chosen.size() > kMostUnbundled ? kDefaultBundle : 0;
  const std::size_t limit = wish.bundle < 0 ? automatic : static_cast<std::size_t>(wish.bundle);

  begin_ = first_numbers_ = 0;
  open_.clear();
  const auto add_stream = [&](bool wanted, const Stream& stream) {
    for (const std::uint32_t i : chosen) {
      if (wanted) add_message(stream, roster->bodies[i], i, limit);
    }
  };
  add_stream(wish.pos, {"/physics/joint/pos", offsets_.joint_position, 3});
  add_stream(wish.rot, {"/physics/joint/rot", offsets_.joint_rotation, 4});
  add_stream(wish.relrot, {"/physics/joint/relrot", offsets_.joint_relrot, 3});
  add_stream(wish.relpos, {"/physics/joint/relpos", offsets_.joint_offsets, 3});
  end_datagram();
  // filled body by body: what is read of a joint lies close together
  std::ranges::stable_sort(numbers_, {}, &Numbers::body);
}

void StreamFrame::add_message(const Stream& stream, const RosterBody& body, std::uint32_t index, std::size_t limit) {
  const std::string_view address = stream.address;
  const std::size_t count = body.joints.size() * stream.width;
  const std::size_t size = padded(address.size()) + padded(2 + count) + padded(body.name.size()) + 4 * count;
  if (size > kLargestPacket) {
    if (too_large_.empty() || too_large_.back() != body.name) too_large_.push_back(body.name);
    return;
  }
  // in a bundle each message has a size before it; a message alone in its datagram needs neither that nor a header
  const std::size_t so_far = bytes_.size() - begin_ + 4 * open_.size();
  if (!open_.empty() && kBundleHeader + so_far + 4 + size > limit) end_datagram();
  append_text(bytes_, address);
  append_text(bytes_, ",s" + std::string(count, 'f'));
  append_text(bytes_, body.name);
  numbers_.push_back({static_cast<std::uint32_t>(bytes_.size()), index, stream.offset, stream.width});
  bytes_.resize(bytes_.size() + 4 * count);
  open_.push_back(static_cast<std::uint32_t>(size));
}

// makes the open messages one datagram: a bundle where they are several
void StreamFrame::end_datagram() {
  if (open_.empty()) return;
  if (open_.size() > 1) {
    std::vector<char> bundle;
    append_text(bundle, "#bundle");
    bundle.resize(kBundleHeader);
    bundle[15] = 1;  // time tag: at once
    std::size_t from = begin_;
    for (std::size_t i = 0; i < open_.size(); i++) {
      bundle.resize(bundle.size() + 4);
      store_u32(bundle.data() + bundle.size() - 4, open_[i]);
      Numbers& numbers = numbers_[first_numbers_ + i];
      numbers.to = static_cast<std::uint32_t>(begin_ + bundle.size() + (numbers.to - from));
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

void StreamFrame::fill(const Snapshot& snapshot) {
  for (const Numbers& n : numbers_) {
    const std::vector<std::uint32_t>& joints = roster_->bodies[n.body].joints;
    char* to = bytes_.data() + n.to;
    const bool inside = n.width == 3 ? write_numbers<3>(to, joints, n.offset, snapshot.live)
                                     : write_numbers<4>(to, joints, n.offset, snapshot.live);
    LIMBER_CHECK(inside);
  }
}

}  // namespace limber
