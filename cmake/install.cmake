# Install rules and the package config that find_package(palpate) finds.
include(CMakePackageConfigHelpers)

install(TARGETS palpate_core palpate_live EXPORT palpateTargets
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
if(PALPATE_BUILD_VIEWER)
  install(TARGETS palpate_viewer EXPORT palpateTargets
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
endif()
install(DIRECTORY include/palpate DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(EXPORT palpateTargets NAMESPACE palpate:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/palpate)
if(PALPATE_BUILD_APP)
  install(TARGETS palpate_app RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
  install(FILES packaging/60-palpate.rules packaging/palpate-limits.conf
    DESTINATION ${CMAKE_INSTALL_DATADIR}/palpate)
endif()

configure_package_config_file(cmake/palpateConfig.cmake.in palpateConfig.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/palpate)
write_basic_package_version_file(palpateConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/palpateConfig.cmake
  ${CMAKE_CURRENT_BINARY_DIR}/palpateConfigVersion.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/palpate)
