// A sum over numbers, each spread over all bits with a key of its own, so that their order does not matter.
#include "params/values_hash.h"

#include <bit>

#include "base/hash.h"

namespace limber {

std::uint64_t values_hash(std::span<const HashedNumber> plan, const double* block) {
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < plan.size(); i++) {
    const auto bits = std::bit_cast<std::uint64_t>(block[i]);
    if (bits == plan[i].initial || plan[i].key == 0) continue;
    std::uint64_t mixed = plan[i].key ^ bits;
    sum += splitmix64(mixed);
  }
  return sum;
}

std::uint64_t kept_hash(const Store& store, NodeId id) {
  return values_hash(store.table(id).hashed_kept(), store.kept_block(id));
}

std::uint64_t node_hash(const Store& store, NodeId id) {
  return kept_hash(store, id) + values_hash(store.table(id).hashed_live(), store.live_block(id));
}

std::uint64_t fixed_node_hash(const Store& store, NodeId id) {
  const std::uint64_t values = kept_hash(store, id);
  if (values == 0) return 0;
  std::uint64_t mixed = values ^ hash_bytes(store.table(id).name());
  return splitmix64(mixed);
}

}  // namespace limber
