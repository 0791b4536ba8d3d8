# CMake toolchain file: cross-compiles for arm64 with Debian's packages of that architecture. qemu-user, if installed, runs
# the programs that the build itself executes.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
set(CMAKE_LIBRARY_ARCHITECTURE aarch64-linux-gnu)
set(PKG_CONFIG_EXECUTABLE /usr/bin/aarch64-linux-gnu-pkg-config)
find_program(LIMBER_EMULATOR qemu-aarch64)
if(LIMBER_EMULATOR)
  set(CMAKE_CROSSCOMPILING_EMULATOR ${LIMBER_EMULATOR})
endif()
