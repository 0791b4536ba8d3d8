// The hash is a sum over the numbers, each mixed with its key, so that their order does not matter.
#include "properties/values_hash.h"

#include <bit>

#include "base/hash.h"

namespace limber {

std::uint64_t values_hash(std::span<const HashedNumber> numbers, const double* block) {
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < numbers.size(); i++) {
    const auto bits = std::bit_cast<std::uint64_t>(block[i]);
    if (bits == numbers[i].initial || numbers[i].key == 0) continue;
    std::uint64_t mixed = numbers[i].key ^ bits;
    sum += splitmix64(mixed);
  }
  return sum;
}

std::uint64_t persistent_hash(const Store& store, NodeId id) {
  return values_hash(store.table(id).hashed_persistent(), store.persistent_block(id));
}

std::uint64_t node_hash(const Store& store, NodeId id) {
  return persistent_hash(store, id) + values_hash(store.table(id).hashed_transient(), store.transient_block(id));
}

std::uint64_t fixed_node_hash(const Store& store, NodeId id) {
  return fixed_node_hash(store.table(id), store.persistent_block(id));
}

std::uint64_t fixed_node_hash(const PropertyTable& table, const double* persistent) {
  const std::uint64_t values = values_hash(table.hashed_persistent(), persistent);
  if (values == 0) return 0;
  std::uint64_t mixed = values ^ hash_bytes(table.name());
  return splitmix64(mixed);
}

}  // namespace limber
