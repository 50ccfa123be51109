# Compile options of every target of ours, as one interface target, so that a project that adds lrbscope as a
# subfolder keeps its own flags.
add_library(lrb_options INTERFACE)
target_compile_features(lrb_options INTERFACE cxx_std_20)
target_include_directories(lrb_options INTERFACE ${PROJECT_SOURCE_DIR})

# No fused multiply-add behind our back: the engine's answer is defined for coordinates rounded after every
# operation, and its error bounds are derived for that order. With contraction, compilers would disagree.
target_compile_options(lrb_options INTERFACE -ffp-contract=off)

# -Wrestrict of gcc 12 is wrong about inlined std::string::replace and operator+ (gcc bug 105329).
target_compile_options(lrb_options INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Wno-psabi
                                             $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)
if(LRB_WARNINGS_AS_ERRORS)
  target_compile_options(lrb_options INTERFACE -Werror)
endif()
if(LRB_NATIVE)
  # With it gcc 12 misjudges the sizes of Boost.Multiprecision's integers.
  target_compile_options(lrb_options INTERFACE -march=native $<$<CXX_COMPILER_ID:GNU>:-Wno-stringop-overflow
                                               -Wno-array-bounds -Wno-maybe-uninitialized>)
endif()
if(LRB_SANITIZE)
  target_compile_options(lrb_options INTERFACE -fsanitize=${LRB_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(lrb_options INTERFACE -fsanitize=${LRB_SANITIZE})
endif()
