# Flags that make memory errors harder to exploit, for optimised builds without sanitizers.

option(FLEETPLAN_HARDEN "Build with stack protector, checked libc functions, full RELRO and PIE" ON)

# The library may become part of a shared library, and its objects are the server's, too: -fPIC instead of -fPIE. No
# function is replaced at run time. The few thread-local bytes of core are found without a call (initial-exec), as every
# loop of a search asks for them; shared libraries with so few can be loaded at any time.
set(position_independent -fPIC -fno-semantic-interposition -ftls-model=initial-exec)

if(FLEETPLAN_HARDEN AND NOT FLEETPLAN_SANITIZE)
  set(optimised $<CONFIG:Release,RelWithDebInfo,MinSizeRel>)  # _FORTIFY_SOURCE needs it
  add_compile_options(-fstack-protector-strong ${position_independent}
                      $<${optimised}:-U_FORTIFY_SOURCE> $<${optimised}:-D_FORTIFY_SOURCE=2>)
  add_link_options(-pie LINKER:-z,relro LINKER:-z,now LINKER:-z,noexecstack)
else()
  add_compile_options(${position_independent})
endif()
