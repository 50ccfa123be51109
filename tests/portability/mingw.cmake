# Toolchain of portability.sh: Debian's MinGW-w64, header-only libraries unpacked in the folder LRB_ROOT, Wine.
set(CMAKE_SYSTEM_NAME Windows)
set(CMAKE_SYSTEM_PROCESSOR AMD64)
set(CMAKE_CXX_COMPILER x86_64-w64-mingw32-g++-posix)
set(CMAKE_TRY_COMPILE_PLATFORM_VARIABLES LRB_ROOT)
set(CMAKE_FIND_ROOT_PATH ${LRB_ROOT} /usr/x86_64-w64-mingw32)
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
set(CMAKE_LIBRARY_ARCHITECTURE x86_64-linux-gnu)  # the folder of Boost's configuration in LRB_ROOT
set(ZLIB_LIBRARY /usr/x86_64-w64-mingw32/lib/libz.a CACHE FILEPATH "The static library")
set(CMAKE_EXE_LINKER_FLAGS_INIT -static)  # so that the programs need no library of the compiler
set(CMAKE_CROSSCOMPILING_EMULATOR wine)
