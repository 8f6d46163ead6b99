# Run at installation: the units with the paths of the prefix that is being installed to. Given: units, from, to,
# dir_BINDIR, dir_SYSCONFDIR.
foreach(variable BINDIR SYSCONFDIR)
  if(IS_ABSOLUTE "${dir_${variable}}")
    set(CMAKE_INSTALL_FULL_${variable} "${dir_${variable}}")
  elseif(variable STREQUAL "SYSCONFDIR" AND CMAKE_INSTALL_PREFIX MATCHES "^/usr/?$")
    set(CMAKE_INSTALL_FULL_SYSCONFDIR /etc)  # as GNUInstallDirs has it
  else()
    set(CMAKE_INSTALL_FULL_${variable} "${CMAKE_INSTALL_PREFIX}/${dir_${variable}}")
  endif()
endforeach()
foreach(unit ${units})
  configure_file(${from}/${unit}.in ${to}/${unit} @ONLY)
  file(INSTALL ${to}/${unit} DESTINATION ${CMAKE_INSTALL_PREFIX}/lib/systemd/system)
endforeach()
