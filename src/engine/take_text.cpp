// Numbers, texts, messages, frames.
#include "engine/take_text.h"

#include <bit>
#include <cmath>
#include <cstring>

#include <fmt/format.h>

#include "base/hash.h"
#include "base/text.h"

namespace limber {

namespace {

// how an argument stands in a form
char type_of(const Arg& arg) {
  if (arg.kind == Arg::Kind::nil) return 'n';
  if (arg.kind == Arg::Kind::text) return 's';
  if (arg.kind == Arg::Kind::boolean) return arg.number != 0 ? 'T' : 'F';
  const double v = arg.number;
  const auto bits = std::bit_cast<std::uint64_t>(v);
  if (std::abs(v) < 1e9 && std::bit_cast<std::uint64_t>(static_cast<double>(static_cast<std::int64_t>(v))) == bits)
    return 'i';
  const bool fits = std::abs(v) < 3e38 && std::bit_cast<std::uint64_t>(double{static_cast<float>(v)}) == bits;
  return fits ? 'f' : 'd';
}

void write_arg(TakeBytes& out, char type, const Arg& arg) {
  if (type == 's') out.text(arg.text);
  if (type == 'f') out.word(std::bit_cast<std::uint32_t>(static_cast<float>(arg.number)), 4);
  if (type == 'd') out.real(arg.number);
  if (type != 'i') return;
  const auto v = static_cast<std::int64_t>(arg.number);
  out.number((static_cast<std::uint64_t>(v) << 1u) ^ static_cast<std::uint64_t>(v >> 63));
}

Arg read_arg(TakeScan& in, char type) {
  if (type == 'T' || type == 'F') return Arg::of(type == 'T');
  if (type == 's') return Arg::of(in.text());
  if (type == 'f') return Arg::of(double{std::bit_cast<float>(static_cast<std::uint32_t>(in.word(4)))});
  if (type == 'd') return Arg::of(in.real());
  if (type == 'i') {
    const std::uint64_t z = in.number();
    return Arg::of(static_cast<double>(static_cast<std::int64_t>(z >> 1u) ^ -static_cast<std::int64_t>(z & 1u)));
  }
  if (type != 'n') in.fail();
  return {};
}

// hand, ip, port, types, 0, address
constexpr std::size_t kFormHead = 7;

}  // namespace

void TakeBytes::number(std::uint64_t value) {
  for (; value >= 0x80; value >>= 7u) byte(static_cast<std::uint8_t>(value | 0x80u));
  byte(static_cast<std::uint8_t>(value));
}

void TakeBytes::word(std::uint64_t value, int bytes) {
  for (int i = 0; i < bytes; i++) byte(static_cast<std::uint8_t>(value >> (8 * i)));
}

void TakeBytes::real(double value) { word(std::bit_cast<std::uint64_t>(value), 8); }

void TakeBytes::text(std::string_view value) {
  number(value.size());
  out_.append(value);
}

std::string_view TakeScan::take(std::size_t bytes) {
  if (bytes > bytes_.size()) {
    bad_ = true;
    bytes_ = {};
    return {};
  }
  const std::string_view taken = bytes_.substr(0, bytes);
  bytes_.remove_prefix(bytes);
  return taken;
}

std::uint8_t TakeScan::byte() {
  const std::string_view taken = take(1);
  return taken.empty() ? 0 : static_cast<std::uint8_t>(taken[0]);
}

std::uint64_t TakeScan::number() {
  std::uint64_t value = 0;
  for (unsigned shift = 0; shift < 64; shift += 7) {
    const std::uint8_t next = byte();
    value |= std::uint64_t{next & 0x7fu} << shift;
    if ((next & 0x80u) == 0) return value;
  }
  bad_ = true;
  return 0;
}

std::uint64_t TakeScan::word(int bytes) {
  std::uint64_t value = 0;
  for (int i = 0; i < bytes; i++) value |= std::uint64_t{byte()} << (8 * i);
  return value;
}

double TakeScan::real() { return std::bit_cast<double>(word(8)); }

std::string_view TakeScan::text() { return take(count()); }

std::size_t TakeScan::count() {
  const std::uint64_t value = number();
  if (value <= bytes_.size()) return static_cast<std::size_t>(value);
  bad_ = true;
  bytes_ = {};
  return 0;
}

void TakeForms::write(TakeBytes& out, const Message& message, const Origin& origin) {
  key_.clear();
  TakeBytes key(key_);
  key.byte(static_cast<std::uint8_t>(origin.hand));
  key.word(origin.ip, 4);
  key.word(origin.port, 2);
  for (const Arg& arg : message.args) key_.push_back(type_of(arg));
  key_.push_back('\0');
  key_.append(message.address);
  const auto known = known_.find(key_);
  if (known != known_.end()) {
    out.number(known->second);
  } else {
    // 1: a form that is remembered from here on; 0: one that is not
    const bool remember = known_.size() < kMost;
    if (remember) known_.emplace(key_, static_cast<std::uint32_t>(known_.size() + 2));
    out.number(remember ? 1 : 0);
    out.text(key_);
  }
  for (std::size_t i = 0; i < message.args.size(); i++) write_arg(out, key_[kFormHead + i], message.args[i]);
}

std::optional<TakeForms::Form> TakeForms::form_of(std::string_view key) {
  const std::size_t end = key.size() > kFormHead ? key.find('\0', kFormHead) : key.npos;
  if (end == key.npos) return {};
  TakeScan head(key);
  const std::uint8_t hand = head.byte();
  if (hand > static_cast<std::uint8_t>(Hand::script)) return {};
  Form form;
  form.origin.hand = static_cast<Hand>(hand);
  form.origin.ip = static_cast<std::uint32_t>(head.word(4));
  form.origin.port = static_cast<std::uint16_t>(head.word(2));
  form.types = key.substr(kFormHead, end - kFormHead);
  form.address = key.substr(end + 1);
  return form;
}

bool TakeForms::read(TakeScan& in, TakeMessage& message) {
  const std::uint64_t which = in.number();
  std::optional<Form> fresh;
  if (which < 2) {
    fresh = form_of(in.text());
    if (!fresh) return false;
  } else if (which - 2 >= forms_.size()) {
    return false;
  }
  const Form& form = fresh ? *fresh : forms_[which - 2];
  message.origin = form.origin;
  message.message.address = form.address;
  std::vector<Arg>& args = message.message.args;
  args.resize(form.types.size());
  for (std::size_t i = 0; i < args.size() && !in.bad(); i++) args[i] = read_arg(in, form.types[i]);
  if (which == 1) forms_.push_back(std::move(*fresh));
  return !in.bad();
}

std::uint32_t frame_check(TakeFrame kind, std::string_view payload) {
  const std::uint64_t hash = hash_bytes(payload, hash_bytes({reinterpret_cast<const char*>(&kind), 1}));
  return static_cast<std::uint32_t>(hash ^ (hash >> 32u));
}

void append_frame(std::string& out, TakeFrame kind, std::string_view payload) {
  TakeBytes bytes(out);
  bytes.byte(static_cast<std::uint8_t>(kind));
  bytes.text(payload);
  bytes.word(frame_check(kind, payload), 4);
}

}  // namespace limber
