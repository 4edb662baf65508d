# SPDX-License-Identifier: Apache-2.0
# What a Debian package must say of itself: under which licence it is, and what has changed. The
# changelog is compressed without a name and a time, so that the same text gives the same bytes.

# boresight_debian_documents(PACKAGE COMPONENT)
function(boresight_debian_documents package component)
  set(debian ${PROJECT_SOURCE_DIR}/resources/debian)
  set(documents ${CMAKE_INSTALL_DATADIR}/doc/${package})
  install(FILES ${debian}/copyright DESTINATION ${documents} COMPONENT ${component})
  find_program(BORESIGHT_GZIP gzip)
  mark_as_advanced(BORESIGHT_GZIP)
  if(BORESIGHT_GZIP)
    set(changelog ${PROJECT_BINARY_DIR}/debian/changelog.gz)
    execute_process(COMMAND ${CMAKE_COMMAND} -E make_directory ${PROJECT_BINARY_DIR}/debian)
    execute_process(COMMAND ${BORESIGHT_GZIP} -9nc ${debian}/changelog OUTPUT_FILE ${changelog}
      COMMAND_ERROR_IS_FATAL ANY)
    set_property(DIRECTORY ${PROJECT_SOURCE_DIR} APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${debian}/changelog)
    install(FILES ${changelog} DESTINATION ${documents} COMPONENT ${component})
  endif()
endfunction()
