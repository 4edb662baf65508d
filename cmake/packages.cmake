# SPDX-License-Identifier: Apache-2.0
# What `cpack` makes in a build folder: a Debian package of the programs, and one of the core for
# other projects.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME boresight)
set(CPACK_PACKAGE_VENDOR "Boresight developers")
set(CPACK_PACKAGE_CONTACT "Boresight developers <developers@boresight.invalid>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
# Whatever the umask of those who build.
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
  OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/cmake/compress_manual_pages.cmake)

set(CPACK_COMPONENTS_ALL core)
if(BORESIGHT_BUILD_SESSIONS)
  list(APPEND CPACK_COMPONENTS_ALL programs)
endif()
if(TARGET boresight_python)
  list(APPEND CPACK_COMPONENTS_ALL python)
endif()
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION TRUE)

set(CPACK_DEBIAN_PROGRAMS_PACKAGE_NAME boresight)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_SHLIBDEPS ON)
# What no library's name says: letters for reports, and Qt's reader of the icon.
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_DEPENDS "fonts-dejavu-core")
if(BORESIGHT_BUILD_UI)
  string(APPEND CPACK_DEBIAN_PROGRAMS_PACKAGE_DEPENDS ", libqt5svg5")
  set(CPACK_DEBIAN_PROGRAMS_PACKAGE_RECOMMENDS "libgl1-mesa-dri")
endif()
set(CPACK_DEBIAN_PROGRAMS_DESCRIPTION
  "localizes a camera before a known object in one image
Boresight finds out where a camera is relative to a known object from one
image, a coarse mesh and a rough guess, by rendering the salient edges of the
object and finding them in the image. This package has the program without a
window (whs), the desktop program (boresight) and examples.")

set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-boresight)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3, python3-numpy, fonts-dejavu-core")
set(CPACK_DEBIAN_PYTHON_DESCRIPTION
  "localizes a camera before a known object: the Python module
Boresight as a Python module: cases, runs with every intermediate as an array,
poses from points, checks, results.")

set(CPACK_DEBIAN_CORE_PACKAGE_NAME libboresight-core-dev)
set(CPACK_DEBIAN_CORE_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_CORE_PACKAGE_DEPENDS "libeigen3-dev (>= 3.4)")
set(CPACK_DEBIAN_CORE_DESCRIPTION
  "localizes a camera before a known object: the flight core
The algorithm of Boresight as a static library with its headers, for
find_package(Boresight) in CMake. It needs Eigen and nothing else.")

include(CPack)
