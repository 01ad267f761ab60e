# SPDX-License-Identifier: Apache-2.0
# Debian packages: `cpack -G DEB --config build/release/CPackConfig.cmake -B DIR`. Needs dpkg-dev, which names the libraries
# that the program was linked with.
set(CPACK_PACKAGE_NAME plumbline)
set(CPACK_PACKAGE_VENDOR "The Plumbline maintainers")
set(CPACK_PACKAGE_CONTACT "The Plumbline maintainers <maintainers@plumbline.invalid>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "testbench for LiDAR SLAM and localization in building plans")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL program dev debian debian_dev)  # `license` stands in the file copyright
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
set(CPACK_COMPONENT_PROGRAM_GROUP program)
set(CPACK_COMPONENT_DEBIAN_GROUP program)
set(CPACK_COMPONENT_DEV_GROUP dev)
set(CPACK_COMPONENT_DEBIAN_DEV_GROUP dev)

set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME plumbline)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_DEPENDS libifcplusplus)  # whose package does not tell what library it holds
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS "python3-numpy")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS "plumbline-dev, slurm-client")
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION
"A legged robot walks through a building model, from IFC or a short plan
file, and carries an emulated 16-ring LiDAR. SLAM and localization methods
estimate its path, and are scored against ground truth. The same seed gives
the same bytes.
.
The binary links parts of CGAL that are under GPL-3, so that it is under
GPL-3 as a whole.")
set(CPACK_DEBIAN_DEV_PACKAGE_NAME plumbline-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS "plumbline (= ${PROJECT_VERSION}-1), libassimp-dev, libboost-dev, libcgal-dev, libceres-dev, libeigen3-dev, libembree-dev, libifcplusplus-dev, liblz4-dev, libmujoco-dev, libpcap-dev, libpcl-dev, librosbag-storage-dev, libsqlite3-dev, libtbb-dev, libyaml-cpp-dev, libzstd-dev, zlib1g-dev")
set(CPACK_COMPONENT_DEV_DESCRIPTION
"Static libraries, headers and a CMake package, for programs that add a
method of their own to the testbench.")
foreach(group program dev)
  string(TOUPPER ${group} upper)
  set(CPACK_COMPONENT_GROUP_${upper}_DESCRIPTION "${CPACK_COMPONENT_${upper}_DESCRIPTION}")
endforeach()

# What Debian asks of every package, and lintian of this one.
string(TIMESTAMP changelog_date "%a, %d %b %Y %H:%M:%S +0000" UTC)  # that of SOURCE_DATE_EPOCH where it is set
foreach(package plumbline plumbline-dev)
  set(component debian)
  if(package STREQUAL plumbline-dev)
    set(component debian_dev)
  endif()
  set(folder ${CMAKE_CURRENT_BINARY_DIR}/debian/${package})
  configure_file(debian/changelog.in ${folder}/changelog.Debian @ONLY)
  execute_process(COMMAND gzip -9nf ${folder}/changelog.Debian COMMAND_ERROR_IS_FATAL ANY)
  configure_file(debian/copyright ${folder}/copyright COPYONLY)
  install(FILES ${folder}/changelog.Debian.gz ${folder}/copyright DESTINATION share/doc/${package} COMPONENT ${component}
    EXCLUDE_FROM_ALL)
endforeach()
include(CPack)
