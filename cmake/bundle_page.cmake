# Bundles the page: cmake -DESBUILD=... -DSOURCE=web -DOUTPUT=folder -P bundle_page.cmake
#
# OUTPUT gets index.html and the files it names, each with a hash of its content in its name: its scripts, one style
# sheet, pictures, and a script for each worker. A worker is recognised by the expression
# new URL("path.js", import.meta.url) in a script.

set(work ${OUTPUT}.work)
set(source ${work}/source)  # a copy, in which references to workers are replaced
set(page ${work}/page)
file(REMOVE_RECURSE ${work})
file(COPY ${SOURCE}/ DESTINATION ${source})
file(WRITE ${work}/tsconfig.json "{}")  # instead of one that esbuild would find in this or an outer folder

# Bundles the file `entry` into `page`; `name` is set to the name of the result.
function(bundle entry name)
  execute_process(
    COMMAND ${ESBUILD} ${entry} --bundle --minify --format=esm --charset=utf8 --sourcemap --loader:.svg=copy
            --loader:.png=copy --entry-names=[name]-[hash] --asset-names=[name]-[hash] --outdir=${page}
            --metafile=${work}/metafile.json --tsconfig=${work}/tsconfig.json --log-level=warning
    WORKING_DIRECTORY ${work}
    COMMAND_ERROR_IS_FATAL ANY)
  file(READ ${work}/metafile.json metafile)
  string(JSON last LENGTH ${metafile} outputs)
  math(EXPR last "${last} - 1")
  get_filename_component(extension ${entry} LAST_EXT)
  foreach(i RANGE ${last})
    string(JSON output MEMBER ${metafile} outputs ${i})
    if(output MATCHES "/([^/]+\\${extension})$")
      set(${name} ${CMAKE_MATCH_1} PARENT_SCOPE)
    endif()
  endforeach()
endfunction()

# Workers first: the scripts that start them contain their names.
file(GLOB_RECURSE scripts ${source}/*.js)
foreach(script ${scripts})
  file(READ ${script} text)
  string(REGEX MATCHALL "new URL\\(\"[^\"]+\\.js\", import\\.meta\\.url\\)" workers "${text}")
  foreach(worker ${workers})
    string(REGEX MATCH "\"(.+)\"" quoted "${worker}")
    set(path ${CMAKE_MATCH_1})
    get_filename_component(folder ${script} DIRECTORY)
    bundle(${folder}/${path} name)
    string(REPLACE "\"${path}\"" "\"./${name}\"" text "${text}")
    file(WRITE ${script} "${text}")
  endforeach()
endforeach()

file(READ ${source}/index.html index)

# All style sheets, in their order, become one.
string(REGEX MATCHALL "<link rel=\"stylesheet\" href=\"[^\"]+\">" links "${index}")
if(NOT links)
  message(FATAL_ERROR "index.html has no <link rel=\"stylesheet\" href=\"...\">")
endif()
set(imports "")
foreach(link ${links})
  string(REGEX MATCH "href=\"(.+)\"" quoted "${link}")
  string(APPEND imports "@import \"../source/${CMAKE_MATCH_1}\";\n")
endforeach()
file(WRITE ${work}/styles/main.css "${imports}")
bundle(${work}/styles/main.css name)
list(GET links 0 first)
string(REPLACE "${first}" "<link rel=\"stylesheet\" href=\"${name}\">" index "${index}")
foreach(link ${links})
  string(REGEX REPLACE "[ \t]*${link}\n" "" index "${index}")
endforeach()

# Then what else it names: scripts and pictures.
string(REGEX MATCHALL " (src|href)=\"[^\":#]+\"" references "${index}")
list(REMOVE_DUPLICATES references)
foreach(reference ${references})
  string(REGEX MATCH "\"(.+)\"" quoted "${reference}")
  set(path ${CMAKE_MATCH_1})
  if(NOT EXISTS ${page}/${path})
    bundle(${source}/${path} name)
    string(REPLACE "\"${path}\"" "\"${name}\"" index "${index}")
  endif()
endforeach()
file(WRITE ${page}/index.html "${index}")

file(REMOVE_RECURSE ${OUTPUT})
file(RENAME ${page} ${OUTPUT})
file(REMOVE_RECURSE ${work})
