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

# Bundles the file `entry` into `page`; `name` is set to the name of the result, `name`_shared to the names of the
# scripts that it imports at once.
function(bundle entry name)
  execute_process(
    COMMAND ${ESBUILD} ${entry} --bundle --minify --format=esm --splitting --charset=utf8 --sourcemap
            --loader:.svg=copy --loader:.png=copy --entry-names=[name]-[hash] --chunk-names=[name]-[hash]
            --asset-names=[name]-[hash] --outdir=${page}
            --metafile=${work}/metafile.json --tsconfig=${work}/tsconfig.json --log-level=warning
    WORKING_DIRECTORY ${work}
    COMMAND_ERROR_IS_FATAL ANY)
  file(READ ${work}/metafile.json metafile)
  string(JSON last LENGTH ${metafile} outputs)
  math(EXPR last "${last} - 1")
  get_filename_component(extension ${entry} LAST_EXT)
  file(RELATIVE_PATH own ${work} ${entry})
  foreach(i RANGE ${last})
    string(JSON output MEMBER ${metafile} outputs ${i})
    string(JSON source ERROR_VARIABLE absent GET ${metafile} outputs ${output} entryPoint)
    if(source STREQUAL own OR (absent AND output MATCHES "\\${extension}$" AND NOT extension STREQUAL ".js"))
      get_filename_component(file ${output} NAME)
      set(${name} ${file} PARENT_SCOPE)
      imports_of("${metafile}" ${output} shared)
      set(${name}_shared ${shared} PARENT_SCOPE)
    endif()
  endforeach()
endfunction()

# Sets `names` to the names of the scripts that an output imports at once, not by import().
function(imports_of metafile output names)
  set(found "")
  string(JSON count LENGTH ${metafile} outputs ${output} imports)
  if(count GREATER 0)
    math(EXPR last "${count} - 1")
    foreach(i RANGE ${last})
      string(JSON kind GET ${metafile} outputs ${output} imports ${i} kind)
      string(JSON path GET ${metafile} outputs ${output} imports ${i} path)
      if(kind STREQUAL "import-statement")
        get_filename_component(file ${path} NAME)
        list(APPEND found ${file})
      endif()
    endforeach()
  endif()
  set(${names} ${found} PARENT_SCOPE)
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

# Then what else it names: scripts and pictures. Links for people lead to the service.
string(REGEX REPLACE "<a [^>]+>" "" named "${index}")
string(REGEX MATCHALL " (src|href)=\"[^\":#]+\"" references "${named}")
list(REMOVE_DUPLICATES references)
foreach(reference ${references})
  string(REGEX MATCH "\"(.+)\"" quoted "${reference}")
  set(path ${CMAKE_MATCH_1})
  if(NOT EXISTS ${page}/${path})
    bundle(${source}/${path} name)
    string(REPLACE "\"${path}\"" "\"${name}\"" index "${index}")
    foreach(shared ${name_shared})
      string(REPLACE "</head>" "  <link rel=\"modulepreload\" href=\"${shared}\">\n</head>" index "${index}")
    endforeach()
  endif()
endforeach()
file(WRITE ${page}/index.html "${index}")

file(REMOVE_RECURSE ${OUTPUT})
file(RENAME ${page} ${OUTPUT})
file(REMOVE_RECURSE ${work})
