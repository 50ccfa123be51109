# `cmake --install`: the program, and the engine for find_package(lrbscope). Traces, pictures and scenarios are parts of
# the program.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(LRB_CMAKE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/lrbscope)
set_target_properties(lrb_engine PROPERTIES EXPORT_NAME engine)
set_target_properties(lrb_options PROPERTIES EXPORT_NAME options)

# What is installed without a component is for those who build with the engine: the parts of packages (cmake/debs.cmake).
set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME dev)
if(LRB_BUILD_PROGRAMS)
  install(TARGETS lrbscope lrbscope-measure RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)
endif()
install(TARGETS lrb_engine lrb_options EXPORT lrbscopeTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})

# The public headers. They may include only public headers, so that what is installed is what is documented.
file(STRINGS ${PROJECT_SOURCE_DIR}/engine/public_headers.txt LRB_PUBLIC_HEADERS REGEX "^[^#]")
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/engine/public_headers.txt)
foreach(header IN LISTS LRB_PUBLIC_HEADERS)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${header})
  file(STRINGS ${PROJECT_SOURCE_DIR}/${header} included REGEX "^#include \"")
  foreach(line IN LISTS included)
    string(REGEX REPLACE "^#include \"(.*)\".*" "\\1" other "${line}")
    if(NOT other IN_LIST LRB_PUBLIC_HEADERS)
      message(FATAL_ERROR "${header} is public, but includes ${other}, which is not: include it in a .cpp file instead, or put it on engine/public_headers.txt")
    endif()
  endforeach()
  get_filename_component(folder ${header} DIRECTORY)
  install(FILES ${PROJECT_SOURCE_DIR}/${header} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/lrbscope/${folder})
endforeach()
install(EXPORT lrbscopeTargets NAMESPACE lrb:: DESTINATION ${LRB_CMAKE_DIR})

configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/lrbscopeConfig.cmake.in
                              ${CMAKE_CURRENT_BINARY_DIR}/lrbscopeConfig.cmake INSTALL_DESTINATION ${LRB_CMAKE_DIR})
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/lrbscopeConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/lrbscopeConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/lrbscopeConfigVersion.cmake
        DESTINATION ${LRB_CMAKE_DIR})
