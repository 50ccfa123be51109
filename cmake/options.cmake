# Compile options of all targets, as interface targets. Users of the libraries inherit only options that affect answers
# (lrb_options). Warnings, tuning and sanitizers (lrb_own_options) apply only to lrbscope's own build, so that a project that
# adds lrbscope as a subfolder, or finds it installed, keeps its own flags.
add_library(lrb_options INTERFACE)
target_compile_features(lrb_options INTERFACE cxx_std_20)
target_include_directories(lrb_options INTERFACE $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
                                                 $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/engine/include>
                                                 $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/trace/include>
                                                 $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/render/include>
                                                 $<INSTALL_INTERFACE:include>)

# The compiler must not contract a * b + c into a fused multiply-add: the engine's answer is defined for coordinates that
# are rounded after every operation, and its error bounds are derived for that. With contraction, compilers would disagree.
set(lrb_unfused -ffp-contract=off)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(aarch64|arm64|ARM64)$")
  list(APPEND lrb_unfused -U__ARM_FEATURE_FMA)  # with this macro, Eigen calls NEON's fused operations
endif()
target_compile_options(lrb_options INTERFACE ${lrb_unfused})

add_library(lrb_own_options INTERFACE)
if(PROJECT_IS_TOP_LEVEL)
  target_link_libraries(lrb_options INTERFACE $<BUILD_INTERFACE:lrb_own_options>)
endif()

# False warnings of gcc 12: -Wrestrict for inlined std::string::replace and operator+ (gcc bug 105329), and -Wstringop-overread
# for moved short strings if their header was precompiled.
target_compile_options(lrb_own_options INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Wno-psabi
                                             $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict -Wno-stringop-overread>)
# The same objects go into programs, shared libraries and the Python module. Symbol interposition is not supported, so the compiler
# may inline functions as without -fPIC.
target_compile_options(lrb_own_options INTERFACE -fPIC -fno-semantic-interposition)
# A unity build takes gcc about 1 GB. Without garbage collection below 600 MB it takes 5 to 10 % less time and 0.2 GB more.
if(CMAKE_UNITY_BUILD)
  set(lrb_uncollected $<$<CXX_COMPILER_ID:GNU>:--param=ggc-min-heapsize=600000>)
  target_compile_options(lrb_own_options INTERFACE ${lrb_uncollected})
  if(NOT PROJECT_IS_TOP_LEVEL)
    add_compile_options(${lrb_uncollected})
  endif()
endif()
# Warnings of compilers that CI does not use are not errors.
set(lrb_compiler "${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION}")
if(LRB_WARNINGS_AS_ERRORS STREQUAL "TRIED" AND NOT lrb_compiler MATCHES "^(GNU 12|Clang 14)\\.")
  set(LRB_WARNINGS_AS_ERRORS OFF)
endif()
if(LRB_WARNINGS_AS_ERRORS)
  target_compile_options(lrb_own_options INTERFACE -Werror)
endif()
if(LRB_NATIVE)
  # False warnings of gcc 12 about the sizes of Boost.Multiprecision's integers.
  target_compile_options(lrb_own_options INTERFACE -march=native $<$<CXX_COMPILER_ID:GNU>:-Wno-stringop-overflow
                                               -Wno-array-bounds -Wno-maybe-uninitialized>)
endif()
if(LRB_SANITIZE)
  target_compile_options(lrb_own_options INTERFACE -fsanitize=${LRB_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(lrb_own_options INTERFACE -fsanitize=${LRB_SANITIZE})
  if(LRB_SANITIZE MATCHES "address")  # clang 14 defines no macro
    target_compile_definitions(lrb_own_options INTERFACE LRB_ADDRESS_SANITIZER)
  endif()
endif()
if(LRB_HARDEN)
  # Checked copies, stack protector, position-independent executables, and relocation tables read-only after loading.
  set(lrb_fortify -U_FORTIFY_SOURCE -D_FORTIFY_SOURCE=2)
  target_compile_options(lrb_options INTERFACE $<BUILD_INTERFACE:-fstack-protector-strong>
                                               "$<BUILD_INTERFACE:$<$<NOT:$<CONFIG:Debug>>:${lrb_fortify}>>")
  # False warnings of gcc 12 about the sizes of Boost.Multiprecision's integers.
  set(lrb_misjudged -Wno-stringop-overflow -Wno-array-bounds)
  target_compile_options(lrb_options INTERFACE "$<BUILD_INTERFACE:$<$<CXX_COMPILER_ID:GNU>:${lrb_misjudged}>>")
  target_link_options(lrb_options INTERFACE $<BUILD_INTERFACE:LINKER:-z,relro> $<BUILD_INTERFACE:LINKER:-z,now>
                                            $<BUILD_INTERFACE:$<$<STREQUAL:$<TARGET_PROPERTY:TYPE>,EXECUTABLE>:-pie>>)
endif()
if(LRB_FUZZ)
  if(NOT CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
    message(FATAL_ERROR "LRB_FUZZ needs clang and its libFuzzer: configure with -DCMAKE_CXX_COMPILER=clang++")
  endif()
  target_compile_options(lrb_options INTERFACE -fsanitize=fuzzer-no-link)
endif()

# The optimisation flags, for programs that print them with their timings.
string(TOUPPER "${CMAKE_BUILD_TYPE}" lrb_build_type)
set(lrb_flags "${CMAKE_CXX_FLAGS_${lrb_build_type}}")
if(LRB_NATIVE)
  string(APPEND lrb_flags " -march=native")
endif()
