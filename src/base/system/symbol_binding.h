// Symbol binding: changes which functions loaded libraries call.
#pragma once

#include <cstddef>
#include <initializer_list>
#include <span>
#include <string_view>

namespace limber::system {

struct SymbolBinding {
  std::string_view name;
  void* function = nullptr;
};

/// Makes the loaded libraries whose file names start with one of `libraries` call these functions, by writing their
/// addresses to the places that the dynamic linker has filled for the symbols. Returns the number of places; 0: there
/// is none, or the system has no ELF files. [any]
std::size_t bind_symbols(std::initializer_list<std::string_view> libraries, std::span<const SymbolBinding> bindings);

}  // namespace limber::system
