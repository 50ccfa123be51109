# `cmake --install`: the program, and the engine for find_package(lrbscope). Traces, pictures and scenarios are parts of
# the program.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(LRB_CMAKE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/lrbscope)
set_target_properties(lrb_engine PROPERTIES EXPORT_NAME engine)
set_target_properties(lrb_options PROPERTIES EXPORT_NAME options)

install(TARGETS lrbscope RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(TARGETS lrb_engine lrb_options EXPORT lrbscopeTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/engine DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/lrbscope
        FILES_MATCHING PATTERN "*.hpp")
install(EXPORT lrbscopeTargets NAMESPACE lrb:: DESTINATION ${LRB_CMAKE_DIR})

configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/lrbscopeConfig.cmake.in
                              ${CMAKE_CURRENT_BINARY_DIR}/lrbscopeConfig.cmake INSTALL_DESTINATION ${LRB_CMAKE_DIR})
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/lrbscopeConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/lrbscopeConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/lrbscopeConfigVersion.cmake
        DESTINATION ${LRB_CMAKE_DIR})
