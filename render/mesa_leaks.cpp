/// For builds with the leak sanitizer: Mesa keeps about a kilobyte per process for good, which is not ours to
/// free. (Pulled in by offscreen.cpp, so that every program that draws has it.)

#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define LRB_LEAK_SANITIZER 1
#endif
#elif defined(__SANITIZE_ADDRESS__)
#define LRB_LEAK_SANITIZER 1
#endif

#ifdef LRB_LEAK_SANITIZER
extern "C" const char* __lsan_default_suppressions();  // NOLINT: the sanitizer's name
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libOSMesa\n";
}
extern "C" const char* __lsan_default_options();  // NOLINT: the sanitizer's name
extern "C" const char* __lsan_default_options() {
  return "print_suppressions=0";  // stderr is for what the program says
}
#endif

namespace lrb::render {
/// Stands for this file where it must be linked.
void suppress_mesa_leaks() {}
}  // namespace lrb::render
