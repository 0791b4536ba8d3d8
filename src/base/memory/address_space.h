// AddressSpace: reserves and commits virtual memory for arenas, and reports the page size (4, 16 or 64 KiB on arm64).
#pragma once

#include <cstddef>
#include <cstdint>

namespace limber {

/// The virtual memory functions that an arena uses. Tests override it to simulate other page sizes and address layouts.
/// [any]
class AddressSpace {
 public:
  /// LuaJIT can only use addresses below 2^47. A system with larger addresses returns higher ones unless a hint asks
  /// for a lower one.
  static constexpr std::uintptr_t kEnd = std::uintptr_t{1} << 47;

  virtual ~AddressSpace() = default;
  static AddressSpace& of_system();

  /// Returns the page size in bytes.
  virtual std::size_t page_size() const;
  /// Reserves a page-aligned address range that ends below kEnd, without access to its memory. Null on failure.
  std::byte* reserve(std::size_t size);
  /// Commits memory, which must be page-aligned. False if the system has no memory left.
  virtual bool commit(std::byte* begin, std::size_t size);
  virtual void release(std::byte* begin, std::size_t size);

 protected:
  /// Reserves an address range, at `hint` if possible (0: anywhere). Null on failure.
  virtual std::byte* map(std::uintptr_t hint, std::size_t size);
};

/// Rounds an address up to a multiple of `alignment` bytes.
std::byte* align_up(std::byte* address, std::size_t alignment);

}  // namespace limber
