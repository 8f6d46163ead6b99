# The library for 64-bit ARM on another machine, its tests under qemu (scripts/portability aarch64). EGOCAL_SYSROOT is a
# folder with the libraries of that architecture, as unpacked from Debian's packages.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
set(CMAKE_LIBRARY_ARCHITECTURE aarch64-linux-gnu)

list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES EGOCAL_SYSROOT)
set(CMAKE_FIND_ROOT_PATH ${EGOCAL_SYSROOT})
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
# libraries of libraries
set(CMAKE_EXE_LINKER_FLAGS_INIT "-Wl,-rpath-link,${EGOCAL_SYSROOT}/usr/lib/aarch64-linux-gnu")

set(CMAKE_CROSSCOMPILING_EMULATOR qemu-aarch64-static -L /usr/aarch64-linux-gnu
    -E LD_LIBRARY_PATH=${EGOCAL_SYSROOT}/usr/lib/aarch64-linux-gnu)
