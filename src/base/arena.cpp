// Chunks of 16 KiB: each has blocks of one size, or is part of a run that is one large block. Lists of chunks with room
// by size; what is empty is given back to all.
#include "base/arena.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "base/sanitized.h"
#include "base/system/virtual_memory.h"

#ifdef LIMBER_WATCHES_ADDRESSES
#include <sanitizer/lsan_interface.h>
#endif

namespace limber {

namespace {

constexpr std::size_t kChunk = 16384;
constexpr std::size_t kGrain = 16;
constexpr std::size_t kFine = 512;      // up to here a size for each grain
constexpr std::size_t kLargest = 4096;  // of a block in a chunk with others
constexpr std::uint32_t kFineKinds = kFine / kGrain;
constexpr std::uint32_t kSteps = 4;  // sizes between two powers of two
constexpr std::uint32_t kKinds = kFineKinds + 3 * kSteps + 1;
constexpr std::uint32_t kFree = 0;  // a chunk that nobody has; kinds are from 1 on
constexpr std::uint32_t kRun = kKinds + 1;
constexpr std::uint32_t kInRun = kKinds + 2;
constexpr std::uint32_t kNone = ~std::uint32_t{0};
// Pages of this size are asked for, but not for the first of them: what walks a large world once a step then finds its
// places sooner, and a small one takes no more than it needs.
constexpr std::size_t kLargePage = std::size_t{2} << 20;

// 1 .. kKinds
std::uint32_t kind_of(std::size_t size) {
  if (size <= kFine) return size == 0 ? 1 : static_cast<std::uint32_t>((size + kGrain - 1) / kGrain);
  const auto power = static_cast<std::uint32_t>(std::bit_width(size - 1) - 1);  // 9 .. 11
  const auto step = static_cast<std::uint32_t>((size - 1 - (std::size_t{1} << power)) >> (power - 2));
  return kFineKinds + (power - 9) * kSteps + step + 1;
}

constexpr std::size_t size_of(std::uint32_t kind) {
  if (kind <= kFineKinds) return kind * kGrain;
  const std::uint32_t at = kind - kFineKinds - 1;
  const std::size_t power = std::size_t{1} << (9 + at / kSteps);
  return power + (at % kSteps + 1) * (power / kSteps);
}

}  // namespace

struct Arena::Chunk {
  void* free = nullptr;  // blocks that were given back, each leads to the next
  std::uint32_t next = kNone, before = kNone;
  std::uint32_t kind = kFree;
  std::uint32_t length = 0;  // chunks of a run
  std::uint16_t fresh = 0;   // blocks that nobody had yet begin behind so many
  std::uint16_t used = 0;
  std::uint32_t spare = 0;
};

struct Arena::Head {
  std::array<std::uint32_t, kKinds + 1> open{};  // by kind: the first chunk with room
  std::uint32_t count = 0;                       // chunks that were ever used
  std::uint32_t lowest = 0;                      // no chunk before this one is free
  std::uint32_t ready = 0;                       // chunks whose memory may be touched
};

namespace {

constexpr std::size_t kHeadSize = 4096;

// What blocks of an arena point to has an owner: the leak sanitizer looks at them, too.
void show_to_leak_search([[maybe_unused]] void* begin, [[maybe_unused]] bool shown) {
#ifdef LIMBER_WATCHES_ADDRESSES
  (shown ? __lsan_register_root_region : __lsan_unregister_root_region)(begin, Arena::kReserve);
#endif
}

}  // namespace

Arena::Arena(AddressSpace& space) : space_(space) {
  static_assert(sizeof(Head) <= kHeadSize && sizeof(Chunk) == 32);
  std::byte* const begin = space.reserve(kReserve);
  if (begin == nullptr) return;
  // memory is committed from the start of a page on, so the data begin at one
  constexpr std::size_t kTable = (kReserve / kChunk * sizeof(Chunk) + kHeadSize + kChunk - 1) / kChunk * kChunk;
  std::byte* const data = next_page(begin + kTable, space.page());
  if (!space.open(begin, static_cast<std::size_t>(data - begin))) {
    space.release(begin, kReserve);
    return;
  }
  show_to_leak_search(begin, true);
  head_ = new (begin) Head;
  head_->open.fill(kNone);
  chunks_ = reinterpret_cast<Chunk*>(begin + kHeadSize);
  data_ = data;
  std::byte* const large = next_page(data_ + kLargePage, kLargePage);
  // a wish: without it all is the same
  system::prefer_large_pages(large, static_cast<std::size_t>(begin + kReserve - large));
}

Arena::~Arena() {
  if (head_ == nullptr) return;
  auto* const begin = reinterpret_cast<std::byte*>(head_);
  show_to_leak_search(begin, false);
  space_.release(begin, kReserve);
}

std::byte* Arena::data_of(std::uint32_t chunk) const { return data_ + std::size_t{chunk} * kChunk; }

std::uint32_t Arena::chunk_of(const void* block) const {
  return static_cast<std::uint32_t>(static_cast<std::size_t>(static_cast<const std::byte*>(block) - data_) / kChunk);
}

void Arena::link(std::uint32_t chunk) {
  std::uint32_t& first = head_->open[chunks_[chunk].kind];
  chunks_[chunk].before = kNone;
  chunks_[chunk].next = first;
  if (first != kNone) chunks_[first].before = chunk;
  first = chunk;
}

void Arena::unlink(std::uint32_t chunk) {
  const Chunk& c = chunks_[chunk];
  if (c.before != kNone) {
    chunks_[c.before].next = c.next;
  } else {
    head_->open[c.kind] = c.next;
  }
  if (c.next != kNone) chunks_[c.next].before = c.before;
}

// so many in a row; kNone: there are none
std::uint32_t Arena::take_chunks(std::uint32_t count) {
  Head& head = *head_;
  while (head.lowest < head.count && chunks_[head.lowest].kind != kFree) head.lowest++;
  std::uint32_t first = head.lowest;
  std::uint32_t found = 0;
  for (std::uint32_t at = first; at < head.count && found < count; at++) {
    if (chunks_[at].kind == kFree) {
      found++;
    } else {
      first = at + 1;
      found = 0;
    }
  }
  const std::uint32_t end = first + count;
  const std::size_t most = (kReserve - static_cast<std::size_t>(data_ - reinterpret_cast<std::byte*>(head_))) / kChunk;
  if (end > most) return kNone;
  if (end > head.ready) {
    // commits up to the end of a large page, which the system provides as a whole; the next commit begins there
    const auto whole = static_cast<std::size_t>(next_page(data_of(end), kLargePage) - data_);
    const auto ready = static_cast<std::uint32_t>(std::min(most, (whole + kChunk - 1) / kChunk));
    if (!space_.open(data_of(head.ready), std::size_t{ready - head.ready} * kChunk)) return kNone;
    head.ready = ready;
  }
  for (std::uint32_t at = head.count; at < end; at++) new (&chunks_[at]) Chunk;
  head.count = std::max(head.count, end);
  return first;
}

void Arena::give_chunks(std::uint32_t first, std::uint32_t count) {
  for (std::uint32_t at = first; at < first + count; at++) chunks_[at] = Chunk{};
  head_->lowest = std::min(head_->lowest, first);
}

bool Arena::open_chunk(std::uint32_t kind) {
  const std::uint32_t chunk = take_chunks(1);
  if (chunk == kNone) return false;
  chunks_[chunk].kind = kind;
  link(chunk);
  return true;
}

void* Arena::allocate_run(std::size_t size) {
  if (size > kReserve) return nullptr;
  const auto count = static_cast<std::uint32_t>((size + kChunk - 1) / kChunk);
  const std::uint32_t first = take_chunks(count);
  if (first == kNone) return nullptr;
  chunks_[first].kind = kRun;
  chunks_[first].length = count;
  for (std::uint32_t at = first + 1; at < first + count; at++) chunks_[at].kind = kInRun;
  return data_of(first);
}

void* Arena::allocate(std::size_t size) {
  if (head_ == nullptr) return nullptr;
  if (size > kLargest) return allocate_run(size);
  const std::uint32_t kind = kind_of(size);
  if (head_->open[kind] == kNone && !open_chunk(kind)) return nullptr;
  const std::uint32_t number = head_->open[kind];
  Chunk& chunk = chunks_[number];
  const std::size_t bytes = size_of(kind);
  void* block = chunk.free;
  if (block != nullptr) {
    chunk.free = *static_cast<void**>(block);
  } else {
    block = data_of(number) + chunk.fresh++ * bytes;
  }
  chunk.used++;
  if (chunk.free == nullptr && (chunk.fresh + std::size_t{1}) * bytes > kChunk) unlink(number);
  return block;
}

void Arena::free(void* block) {
  const std::uint32_t number = chunk_of(block);
  Chunk& chunk = chunks_[number];
  if (chunk.kind == kRun) return give_chunks(number, chunk.length);
  const bool was_full = chunk.free == nullptr && (chunk.fresh + std::size_t{1}) * size_of(chunk.kind) > kChunk;
  *static_cast<void**>(block) = chunk.free;
  chunk.free = block;
  chunk.used--;
  if (was_full) link(number);
  // the last with room stays, so that a block that comes and goes moves no chunks
  if (chunk.used > 0 || (chunk.next == kNone && chunk.before == kNone)) return;
  unlink(number);
  give_chunks(number, 1);
}

void* Arena::resize(void* block, std::size_t before, std::size_t after) {
  if (after == 0) {
    if (block != nullptr) free(block);
    return nullptr;
  }
  if (block == nullptr) return allocate(after);
  const Chunk& chunk = chunks_[chunk_of(block)];
  const std::size_t room = chunk.kind == kRun ? chunk.length * kChunk : size_of(chunk.kind);
  // in its place where it fits and wastes less than half
  if (after <= room && (after > room / 2 || room <= kGrain)) return block;
  void* const moved = allocate(after);
  if (moved == nullptr) return after <= room ? block : nullptr;
  std::memcpy(moved, block, std::min(before, after));
  free(block);
  return moved;
}

void Arena::copy(PageStore& pages, const PageStore::Image* before, PageStore::Image& out) const {
  out.clear();
  if (head_ == nullptr) return;
  const auto* const head = reinterpret_cast<const std::byte*>(head_);
  pages.append(out, {head, kHeadSize + head_->count * sizeof(Chunk)}, before);
  for (std::uint32_t at = 0; at < head_->count; at++) {
    if (chunks_[at].kind == kFree) {
      pages.append_none(out, kChunk);
    } else {
      pages.append(out, {data_of(at), kChunk}, before);
    }
  }
}

void Arena::bring_back(const PageStore& pages, const PageStore::Image& image) {
  if (head_ == nullptr || image.empty()) return;
  // what may be touched stays so
  const std::uint32_t ready = head_->ready;
  auto* const head = reinterpret_cast<std::byte*>(head_);
  std::size_t at = pages.copy_back(image, 0, {head, kHeadSize});
  at = pages.copy_back(image, at, {head + kHeadSize, head_->count * sizeof(Chunk)});
  head_->ready = ready;
  for (std::uint32_t chunk = 0; chunk < head_->count; chunk++) {
    at = pages.copy_back(image, at, {data_of(chunk), kChunk});
  }
}

}  // namespace limber
