# Libraries that only commands use. Included by scenarios/, which decides whether the program is built.
find_package(CLI11 QUIET)
lrb_need(program libcli11-dev CLI11_FOUND)
find_package(PkgConfig QUIET)
if(PkgConfig_FOUND)
  pkg_check_modules(LRB_HTTPLIB QUIET cpp-httplib)  # the page of `lrbscope live`
endif()
lrb_need(program libcpp-httplib-dev LRB_HTTPLIB_FOUND)
