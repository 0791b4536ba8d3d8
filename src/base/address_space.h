// AddressSpace: stretches of addresses from the system, and the size of its pages, which is 4, 16 or 64 KiB on arm64.
#pragma once

#include <cstddef>
#include <cstdint>

namespace limber {

/// What an arena asks of the system. Tests replace it to simulate other pages and other layouts of addresses. [any]
class AddressSpace {
 public:
  /// LuaJIT has 47 bits for an address. A system whose addresses have 48 or more gives higher ones unless it is asked
  /// for a lower one.
  static constexpr std::uintptr_t kEnd = std::uintptr_t{1} << 47;

  virtual ~AddressSpace() = default;
  static AddressSpace& of_system();

  /// Bytes of a page.
  virtual std::size_t page() const;
  /// A stretch that begins at a page and ends below kEnd, without access to its memory. Null: there is none.
  std::byte* reserve(std::size_t size);
  /// Gives access to memory that begins at a page. False: the system has no more.
  virtual bool open(std::byte* begin, std::size_t size);
  virtual void release(std::byte* begin, std::size_t size);

 protected:
  /// A new stretch, at `wish` if the system can; null: there is none.
  virtual std::byte* map(std::uintptr_t wish, std::size_t size);
};

/// The place at or after this one where a page begins.
std::byte* next_page(std::byte* place, std::size_t page);

}  // namespace limber
