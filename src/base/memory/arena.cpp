// Size-class allocator: chunks of 16 KiB contain blocks of one size class, or form a run of chunks for a large block.
// Each size class has a list of chunks with free blocks; empty chunks return to the pool of free chunks.
#include "base/memory/arena.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "base/sanitized.h"
#include "base/system/virtual_memory.h"

#ifdef LIMBER_ADDRESS_SANITIZER
#include <sanitizer/lsan_interface.h>
#endif

namespace limber {

namespace {

constexpr std::size_t kChunk = 16384;
constexpr std::size_t kGrain = 16;
constexpr std::size_t kMaxFineSize = 512;    // size classes are multiples of kGrain up to this size
constexpr std::size_t kMaxClassSize = 4096;  // larger blocks get a run of chunks
constexpr std::uint32_t kFineClasses = kMaxFineSize / kGrain;
constexpr std::uint32_t kClassesPerOctave = 4;  // size classes per power of two above kMaxFineSize
constexpr std::uint32_t kSizeClasses = kFineClasses + 3 * kClassesPerOctave + 1;
constexpr std::uint32_t kFree = 0;  // a free chunk; size classes begin at 1
constexpr std::uint32_t kRun = kSizeClasses + 1;
constexpr std::uint32_t kInRun = kSizeClasses + 2;
constexpr std::uint32_t kNone = ~std::uint32_t{0};
// Requests large pages, except for the first 2 MiB: a large world then has fewer TLB misses, and a small one uses no
// more memory than it needs.
constexpr std::size_t kLargePage = std::size_t{2} << 20;

// Returns the size class, 1 .. kSizeClasses.
std::uint32_t size_class_of(std::size_t size) {
  if (size <= kMaxFineSize) return size == 0 ? 1 : static_cast<std::uint32_t>((size + kGrain - 1) / kGrain);
  const auto power = static_cast<std::uint32_t>(std::bit_width(size - 1) - 1);  // 9 .. 11
  const auto step = static_cast<std::uint32_t>((size - 1 - (std::size_t{1} << power)) >> (power - 2));
  return kFineClasses + (power - 9) * kClassesPerOctave + step + 1;
}

constexpr std::size_t class_size(std::uint32_t kind) {
  if (kind <= kFineClasses) return kind * kGrain;
  const std::uint32_t at = kind - kFineClasses - 1;
  const std::size_t power = std::size_t{1} << (9 + at / kClassesPerOctave);
  return power + (at % kClassesPerOctave + 1) * (power / kClassesPerOctave);
}

}  // namespace

struct Arena::Chunk {
  void* free_list = nullptr;  // linked list of free blocks
  std::uint32_t next = kNone, previous = kNone;
  std::uint32_t kind = kFree;
  std::uint32_t length = 0;        // chunks of a run
  std::uint16_t first_unused = 0;  // blocks from this index on were never used
  std::uint16_t used = 0;
  std::uint32_t padding = 0;
};

struct Arena::Head {
  std::array<std::uint32_t, kSizeClasses + 1> open{};  // by size class: the first chunk with free blocks
  std::uint32_t count = 0;                             // chunks that were ever used
  std::uint32_t first_free = 0;                        // no chunk before this one is free
  std::uint32_t committed = 0;                         // chunks with committed memory
};

namespace {

constexpr std::size_t kHeadSize = 4096;

// Makes the leak sanitizer scan the arena for pointers to memory outside it.
void set_leak_root([[maybe_unused]] void* begin, [[maybe_unused]] bool registered) {
#ifdef LIMBER_ADDRESS_SANITIZER
  (registered ? __lsan_register_root_region : __lsan_unregister_root_region)(begin, Arena::kReserve);
#endif
}

}  // namespace

Arena::Arena(AddressSpace& space) : space_(space) {
  static_assert(sizeof(Head) <= kHeadSize && sizeof(Chunk) == 32);
  std::byte* const begin = space.reserve(kReserve);
  if (begin == nullptr) return;
  // Memory is committed in whole pages, so the data must be page-aligned.
  constexpr std::size_t kTable = (kReserve / kChunk * sizeof(Chunk) + kHeadSize + kChunk - 1) / kChunk * kChunk;
  std::byte* const data = align_up(begin + kTable, space.page_size());
  if (!space.commit(begin, static_cast<std::size_t>(data - begin))) {
    space.release(begin, kReserve);
    return;
  }
  set_leak_root(begin, true);
  head_ = new (begin) Head;
  head_->open.fill(kNone);
  chunks_ = reinterpret_cast<Chunk*>(begin + kHeadSize);
  data_ = data;
  std::byte* const large = align_up(data_ + kLargePage, kLargePage);
  // A hint: failure has no consequences.
  system::prefer_large_pages(large, static_cast<std::size_t>(begin + kReserve - large));
}

Arena::~Arena() {
  if (head_ == nullptr) return;
  auto* const begin = reinterpret_cast<std::byte*>(head_);
  set_leak_root(begin, false);
  space_.release(begin, kReserve);
}

std::byte* Arena::data_of(std::uint32_t chunk) const { return data_ + std::size_t{chunk} * kChunk; }

std::uint32_t Arena::chunk_of(const void* block) const {
  return static_cast<std::uint32_t>(static_cast<std::size_t>(static_cast<const std::byte*>(block) - data_) / kChunk);
}

void Arena::link(std::uint32_t chunk) {
  std::uint32_t& first = head_->open[chunks_[chunk].kind];
  chunks_[chunk].previous = kNone;
  chunks_[chunk].next = first;
  if (first != kNone) chunks_[first].previous = chunk;
  first = chunk;
}

void Arena::unlink(std::uint32_t chunk) {
  const Chunk& c = chunks_[chunk];
  if (c.previous != kNone) {
    chunks_[c.previous].next = c.next;
  } else {
    head_->open[c.kind] = c.next;
  }
  if (c.next != kNone) chunks_[c.next].previous = c.previous;
}

// Returns the first of `count` consecutive free chunks, or kNone.
std::uint32_t Arena::allocate_chunks(std::uint32_t count) {
  Head& head = *head_;
  while (head.first_free < head.count && chunks_[head.first_free].kind != kFree) head.first_free++;
  std::uint32_t first = head.first_free;
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
  const std::size_t max_chunks =
      (kReserve - static_cast<std::size_t>(data_ - reinterpret_cast<std::byte*>(head_))) / kChunk;
  if (end > max_chunks) return kNone;
  if (end > head.committed) {
    // Commits up to the end of a large page, which the system provides as a whole.
    const auto page_end = static_cast<std::size_t>(align_up(data_of(end), kLargePage) - data_);
    const auto committed = static_cast<std::uint32_t>(std::min(max_chunks, (page_end + kChunk - 1) / kChunk));
    if (!space_.commit(data_of(head.committed), std::size_t{committed - head.committed} * kChunk)) return kNone;
    head.committed = committed;
  }
  for (std::uint32_t at = head.count; at < end; at++) new (&chunks_[at]) Chunk;
  head.count = std::max(head.count, end);
  return first;
}

void Arena::free_chunks(std::uint32_t first, std::uint32_t count) {
  for (std::uint32_t at = first; at < first + count; at++) chunks_[at] = Chunk{};
  head_->first_free = std::min(head_->first_free, first);
}

bool Arena::open_chunk(std::uint32_t kind) {
  const std::uint32_t chunk = allocate_chunks(1);
  if (chunk == kNone) return false;
  chunks_[chunk].kind = kind;
  link(chunk);
  return true;
}

void* Arena::allocate_run(std::size_t size) {
  if (size > kReserve) return nullptr;
  const auto count = static_cast<std::uint32_t>((size + kChunk - 1) / kChunk);
  const std::uint32_t first = allocate_chunks(count);
  if (first == kNone) return nullptr;
  chunks_[first].kind = kRun;
  chunks_[first].length = count;
  for (std::uint32_t at = first + 1; at < first + count; at++) chunks_[at].kind = kInRun;
  return data_of(first);
}

void* Arena::allocate(std::size_t size) {
  if (head_ == nullptr) return nullptr;
  if (size > kMaxClassSize) return allocate_run(size);
  const std::uint32_t kind = size_class_of(size);
  if (head_->open[kind] == kNone && !open_chunk(kind)) return nullptr;
  const std::uint32_t number = head_->open[kind];
  Chunk& chunk = chunks_[number];
  const std::size_t bytes = class_size(kind);
  void* block = chunk.free_list;
  if (block != nullptr) {
    chunk.free_list = *static_cast<void**>(block);
  } else {
    block = data_of(number) + chunk.first_unused++ * bytes;
  }
  chunk.used++;
  if (chunk.free_list == nullptr && (chunk.first_unused + std::size_t{1}) * bytes > kChunk) unlink(number);
  return block;
}

void Arena::free(void* block) {
  const std::uint32_t number = chunk_of(block);
  Chunk& chunk = chunks_[number];
  if (chunk.kind == kRun) return free_chunks(number, chunk.length);
  const bool was_full =
      chunk.free_list == nullptr && (chunk.first_unused + std::size_t{1}) * class_size(chunk.kind) > kChunk;
  *static_cast<void**>(block) = chunk.free_list;
  chunk.free_list = block;
  chunk.used--;
  if (was_full) link(number);
  // Keep the last chunk of a size class, so that repeated allocate/free of one block does not free chunks.
  if (chunk.used > 0 || (chunk.next == kNone && chunk.previous == kNone)) return;
  unlink(number);
  free_chunks(number, 1);
}

void* Arena::resize(void* block, std::size_t before, std::size_t after) {
  if (after == 0) {
    if (block != nullptr) free(block);
    return nullptr;
  }
  if (block == nullptr) return allocate(after);
  const Chunk& chunk = chunks_[chunk_of(block)];
  const std::size_t capacity = chunk.kind == kRun ? chunk.length * kChunk : class_size(chunk.kind);
  // Stays in place if it fits and wastes less than half.
  if (after <= capacity && (after > capacity / 2 || capacity <= kGrain)) return block;
  void* const moved = allocate(after);
  if (moved == nullptr) return after <= capacity ? block : nullptr;
  std::memcpy(moved, block, std::min(before, after));
  free(block);
  return moved;
}

void Arena::capture(PageStore& pages, const PageStore::PageList* before, PageStore::PageList& out) const {
  out.clear();
  if (head_ == nullptr) return;
  const auto* const head = reinterpret_cast<const std::byte*>(head_);
  pages.append(out, {head, kHeadSize + head_->count * sizeof(Chunk)}, before);
  for (std::uint32_t at = 0; at < head_->count; at++) {
    if (chunks_[at].kind == kFree) {
      pages.append_placeholders(out, kChunk);
    } else {
      pages.append(out, {data_of(at), kChunk}, before);
    }
  }
}

void Arena::restore(const PageStore& pages, const PageStore::PageList& copy) {
  if (head_ == nullptr || copy.empty()) return;
  // Committed memory stays committed.
  const std::uint32_t committed = head_->committed;
  auto* const head = reinterpret_cast<std::byte*>(head_);
  std::size_t at = pages.restore(copy, 0, {head, kHeadSize});
  at = pages.restore(copy, at, {head + kHeadSize, head_->count * sizeof(Chunk)});
  head_->committed = committed;
  for (std::uint32_t chunk = 0; chunk < head_->count; chunk++) {
    at = pages.restore(copy, at, {data_of(chunk), kChunk});
  }
}

}  // namespace limber
