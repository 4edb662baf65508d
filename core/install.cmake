# SPDX-License-Identifier: Apache-2.0
# What other projects need of the core: the library, its headers, and find_package(Boresight).
include(CMakePackageConfigHelpers)

set(BORESIGHT_CONFIG_FOLDER ${CMAKE_INSTALL_LIBDIR}/cmake/Boresight)

set_target_properties(boresight_core PROPERTIES EXPORT_NAME core)
install(TARGETS boresight_core EXPORT BoresightTargets
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT core)
install(DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR} DESTINATION ${BORESIGHT_INCLUDES}
  COMPONENT core FILES_MATCHING PATTERN *.h)
install(EXPORT BoresightTargets NAMESPACE Boresight:: DESTINATION ${BORESIGHT_CONFIG_FOLDER}
  COMPONENT core)

configure_package_config_file(
  ${PROJECT_SOURCE_DIR}/cmake/BoresightConfig.cmake.in
  ${CMAKE_CURRENT_BINARY_DIR}/BoresightConfig.cmake
  INSTALL_DESTINATION ${BORESIGHT_CONFIG_FOLDER})
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/BoresightConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES
  ${CMAKE_CURRENT_BINARY_DIR}/BoresightConfig.cmake
  ${CMAKE_CURRENT_BINARY_DIR}/BoresightConfigVersion.cmake
  DESTINATION ${BORESIGHT_CONFIG_FOLDER} COMPONENT core)
boresight_debian_documents(libboresight-core-dev core)
