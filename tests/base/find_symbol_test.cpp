// Lookup of functions of loaded libraries by name.
#include <dlfcn.h>

#include <gtest/gtest.h>

#include "base/system/process.h"

namespace limber {
namespace {

// a part of the C library that this program is not linked with
constexpr const char* kLibrary = "libnss_compat.so.2";
constexpr const char* kFunction = "_nss_compat_getpwnam_r";

TEST(FindSymbol, FindsFunctionsOfLinkedLibraries) {
  EXPECT_NE(system::find_symbol("malloc"), nullptr);
  EXPECT_EQ(system::find_symbol("no_such_function_anywhere"), nullptr);
}

TEST(FindSymbol, FindsFunctionsOfPrivatelyLoadedLibraries) {
  ASSERT_EQ(system::find_symbol(kFunction), nullptr);
  void* const library = dlopen(kLibrary, RTLD_LAZY | RTLD_LOCAL);
  ASSERT_NE(library, nullptr) << dlerror();
  EXPECT_EQ(system::find_symbol(kFunction), dlsym(library, kFunction));
  dlclose(library);
}

}  // namespace
}  // namespace limber
