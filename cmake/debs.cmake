# Debian packages: `cd build/release && cpack` writes them to build/release/debs. Configure with -DCMAKE_INSTALL_PREFIX=/usr, as ./check
# debs does, so that libraries are in Debian's folder for the processor. One package per installed component:
#   program   lrbscope           the program, its manual pages and completions
#   library   liblrbscopeX.Y     the shared libraries, if they are built (install(... COMPONENT library); X.Y: the sonames' version)
#   dev       liblrbscope-dev    headers, the static library, CMake's and pkg-config's files: all files without a component
#   python    python3-lrbscope   the Python module, if it is built (install(... COMPONENT python))
# dpkg-shlibdeps finds the dependencies on shared libraries.
get_cmake_property(lrb_components COMPONENTS)
set(CPACK_COMPONENTS_ALL "")
foreach(component IN ITEMS program library dev python)
  if(component IN_LIST lrb_components)
    list(APPEND CPACK_COMPONENTS_ALL ${component})
  endif()
endforeach()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME lrbscope)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/debs)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "exact collision detection for meshes, with recording and pictures")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ
                                                WORLD_EXECUTE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_SOURCE lrbscope)
set(LRB_MAINTAINER "The lrbscope authors <lrbscope@example.org>" CACHE STRING "Maintainer of the Debian packages")
set(CPACK_DEBIAN_PACKAGE_MAINTAINER "${LRB_MAINTAINER}")
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS_POLICY ">=")
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

# Package descriptions, wrapped as displayed.
set(lrb_about "lrbscope finds the intersecting faces of two bodies of any shape, exactly.
It converts meshes to LRB-reps, whose coarse wrappers are refined only
where the bodies are close to each other.

")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME lrbscope)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION science)
# Loaded at run time, for pictures; libegl1 without libgl1-mesa-dri cannot draw.
set(lrb_draws "libosmesa6 | libegl1, libosmesa6 | libgl1-mesa-dri")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_DEPENDS "fonts-dejavu-core, ${lrb_draws}")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS gnuplot-nox)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS ffmpeg)
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION "${lrb_about}This package contains the program, which records, replays and draws every
comparison and every refinement, as pictures, pages and traces.")

set(CPACK_DEBIAN_DEV_PACKAGE_NAME liblrbscope-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEV_PACKAGE_SHLIBDEPS OFF)
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS "libeigen3-dev, libboost-dev, libtbb-dev, nlohmann-json3-dev, zlib1g-dev, \
libcairo2-dev, libpng-dev, libglm-dev")
set(CPACK_DEBIAN_DEV_PACKAGE_RECOMMENDS "${lrb_draws}")
set(CPACK_COMPONENT_DEV_DESCRIPTION "${lrb_about}This package contains the headers and the library for find_package(lrbscope).")

if(library IN_LIST CPACK_COMPONENTS_ALL)
  set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME liblrbscope${lrb_soversion})
  set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libs)
  set(CPACK_DEBIAN_LIBRARY_PACKAGE_RECOMMENDS "${lrb_draws}")
  file(WRITE ${PROJECT_BINARY_DIR}/debs_doc/triggers "activate-noawait ldconfig\n")
  set(CPACK_DEBIAN_LIBRARY_PACKAGE_CONTROL_EXTRA ${PROJECT_BINARY_DIR}/debs_doc/triggers)
  set(CPACK_COMPONENT_LIBRARY_DESCRIPTION "${lrb_about}This package contains the shared library.")
  string(APPEND CPACK_DEBIAN_DEV_PACKAGE_DEPENDS
         ", ${CPACK_DEBIAN_LIBRARY_PACKAGE_NAME} (= ${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE})")
endif()
if(python IN_LIST CPACK_COMPONENTS_ALL)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-lrbscope)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  math(EXPR lrb_next_python "${LRB_PYTHON_MINOR} + 1")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3 (>= 3.${LRB_PYTHON_MINOR}~), python3 (<< 3.${lrb_next_python}), \
python3-numpy, fonts-dejavu-core, ${lrb_draws}")
  set(CPACK_COMPONENT_PYTHON_DESCRIPTION "${lrb_about}This package contains the Python module, which takes NumPy arrays.")
endif()

# Every package's copyright and changelogs.
find_program(LRB_GZIP gzip DOC "gzip, for manual pages and changelogs")
string(TIMESTAMP lrb_deb_date "%a, %d %b %Y %H:%M:%S +0000" UTC)
foreach(component IN LISTS CPACK_COMPONENTS_ALL)
  string(TOUPPER ${component} upper)
  set(name ${CPACK_DEBIAN_${upper}_PACKAGE_NAME})
  install(FILES ${PROJECT_SOURCE_DIR}/cmake/debs/copyright DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${name}
          COMPONENT ${component})
  if(LRB_GZIP)
    set(folder ${PROJECT_BINARY_DIR}/debs_doc/${name})
    file(CONFIGURE OUTPUT ${folder}/changelog.Debian @ONLY CONTENT
"lrbscope (@PROJECT_VERSION@-@CPACK_DEBIAN_PACKAGE_RELEASE@) unstable; urgency=medium

  * Release @PROJECT_VERSION@; changelog.gz says what changed.

 -- @CPACK_DEBIAN_PACKAGE_MAINTAINER@  @lrb_deb_date@
")
    configure_file(${PROJECT_SOURCE_DIR}/CHANGELOG.md ${folder}/changelog COPYONLY)
    execute_process(COMMAND ${LRB_GZIP} -9nf ${folder}/changelog.Debian ${folder}/changelog COMMAND_ERROR_IS_FATAL ANY)
    install(FILES ${folder}/changelog.Debian.gz ${folder}/changelog.gz DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${name}
            COMPONENT ${component})
  endif()
endforeach()
include(CPack)
