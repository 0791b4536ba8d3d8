// Symbol binding for ELF: rewrites the relocated words of a library. Pages that the dynamic linker has made read-only
// (RELRO) are made writable while a word is written.
#include "base/system/symbol_binding.h"

#include <algorithm>
#include <atomic>
#include <cstdint>

#include "base/system/virtual_memory.h"

#if defined(__ELF__) && __SIZEOF_POINTER__ == 8
#include <link.h>
#include <sys/mman.h>
#endif

namespace limber::system {

#if defined(__ELF__) && __SIZEOF_POINTER__ == 8

namespace {

#if defined(__aarch64__)
constexpr std::uint64_t kJumpSlot = R_AARCH64_JUMP_SLOT;
constexpr std::uint64_t kGlobalData = R_AARCH64_GLOB_DAT;
constexpr std::uint64_t kAbsolute = R_AARCH64_ABS64;
#else
constexpr std::uint64_t kJumpSlot = R_X86_64_JUMP_SLOT;
constexpr std::uint64_t kGlobalData = R_X86_64_GLOB_DAT;
constexpr std::uint64_t kAbsolute = R_X86_64_64;
#endif

// NOLINTBEGIN(performance-no-int-to-ptr): the dynamic section has addresses as integers
struct Tables {
  const Elf64_Sym* symbols = nullptr;
  const char* names = nullptr;
  std::span<const Elf64_Rela> relocations;
  std::span<const Elf64_Rela> jumps;
};

// glibc stores addresses in the dynamic section, musl offsets from the load address
std::uintptr_t address_of(const dl_phdr_info& library, std::uintptr_t value) {
  return value < library.dlpi_addr ? library.dlpi_addr + value : value;
}

Tables tables_of(const dl_phdr_info& library) {
  Tables tables;
  const Elf64_Dyn* entry = nullptr;
  for (int i = 0; i < library.dlpi_phnum; i++) {
    if (library.dlpi_phdr[i].p_type == PT_DYNAMIC)
      entry = reinterpret_cast<const Elf64_Dyn*>(library.dlpi_addr + library.dlpi_phdr[i].p_vaddr);
  }
  const Elf64_Rela* relocations = nullptr;
  const Elf64_Rela* jumps = nullptr;
  std::size_t relocation_bytes = 0;
  std::size_t jump_bytes = 0;
  for (; entry != nullptr && entry->d_tag != DT_NULL; entry++) {
    const std::uintptr_t address = address_of(library, entry->d_un.d_ptr);
    switch (entry->d_tag) {
      case DT_SYMTAB:
        tables.symbols = reinterpret_cast<const Elf64_Sym*>(address);
        break;
      case DT_STRTAB:
        tables.names = reinterpret_cast<const char*>(address);
        break;
      case DT_RELA:
        relocations = reinterpret_cast<const Elf64_Rela*>(address);
        break;
      case DT_RELASZ:
        relocation_bytes = entry->d_un.d_val;
        break;
      case DT_JMPREL:
        jumps = reinterpret_cast<const Elf64_Rela*>(address);
        break;
      case DT_PLTRELSZ:
        jump_bytes = entry->d_un.d_val;
        break;
      default:
        break;
    }
  }
  if (relocations != nullptr) tables.relocations = {relocations, relocation_bytes / sizeof(Elf64_Rela)};
  if (jumps != nullptr) tables.jumps = {jumps, jump_bytes / sizeof(Elf64_Rela)};
  return tables;
}

// True if the page is in the part that is read-only after relocation, or in a read-only segment.
bool is_read_only(const dl_phdr_info& library, std::uintptr_t page) {
  bool writable = false;
  bool relro = false;
  for (int i = 0; i < library.dlpi_phnum; i++) {
    const Elf64_Phdr& segment = library.dlpi_phdr[i];
    const std::uintptr_t begin = library.dlpi_addr + segment.p_vaddr;
    const std::uintptr_t end = begin + segment.p_memsz;
    const bool inside = page + page_size() > begin && page < end;
    if (inside && segment.p_type == PT_LOAD && (segment.p_flags & PF_W) != 0) writable = true;
    // the linker protects whole pages only
    if (segment.p_type == PT_GNU_RELRO && page >= begin / page_size() * page_size() &&
        page + page_size() <= end / page_size() * page_size())
      relro = true;
  }
  return relro || !writable;
}

bool write_word(const dl_phdr_info& library, std::uintptr_t place, std::uintptr_t value) {
  const std::uintptr_t page = place / page_size() * page_size();
  const bool read_only = is_read_only(library, page);
  auto* const start = reinterpret_cast<void*>(page);
  if (read_only && mprotect(start, page_size(), PROT_READ | PROT_WRITE) != 0) return false;
  std::atomic_ref(*reinterpret_cast<std::uintptr_t*>(place)).store(value);  // other threads may call the function
  if (read_only) (void)mprotect(start, page_size(), PROT_READ);
  return true;
}

struct Request {
  std::initializer_list<std::string_view> libraries;
  std::span<const SymbolBinding> bindings;
  std::size_t count = 0;
};

void bind_relocations(const dl_phdr_info& library, const Tables& tables, std::span<const Elf64_Rela> list,
                      Request& request) {
  for (const Elf64_Rela& relocation : list) {
    const std::uint64_t type = ELF64_R_TYPE(relocation.r_info);
    const std::uint64_t symbol = ELF64_R_SYM(relocation.r_info);
    if (symbol == 0 || (type != kJumpSlot && type != kGlobalData && type != kAbsolute)) continue;
    const std::string_view name = tables.names + tables.symbols[symbol].st_name;
    const auto found = std::ranges::find(request.bindings, name, &SymbolBinding::name);
    if (found == request.bindings.end()) continue;
    const auto value = reinterpret_cast<std::uintptr_t>(found->function) +
                       (type == kAbsolute ? static_cast<std::uintptr_t>(relocation.r_addend) : 0);
    if (write_word(library, library.dlpi_addr + relocation.r_offset, value)) request.count++;
  }
}
// NOLINTEND(performance-no-int-to-ptr)

int bind_library(dl_phdr_info* library, std::size_t, void* context) {
  Request& request = *static_cast<Request*>(context);
  std::string_view name = library->dlpi_name == nullptr ? "" : library->dlpi_name;
  name = name.substr(name.rfind('/') + 1);
  if (std::ranges::none_of(request.libraries, [&](std::string_view start) { return name.starts_with(start); }))
    return 0;
  const Tables tables = tables_of(*library);
  if (tables.symbols == nullptr || tables.names == nullptr) return 0;
  bind_relocations(*library, tables, tables.relocations, request);
  bind_relocations(*library, tables, tables.jumps, request);
  return 0;
}

}  // namespace

std::size_t bind_symbols(std::initializer_list<std::string_view> libraries, std::span<const SymbolBinding> bindings) {
  Request request{libraries, bindings};
  dl_iterate_phdr(&bind_library, &request);
  return request.count;
}

#else

std::size_t bind_symbols(std::initializer_list<std::string_view>, std::span<const SymbolBinding>) { return 0; }

#endif

}  // namespace limber::system
