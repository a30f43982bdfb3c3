# Before a package is made: its folders are open to all, whatever the umask of who makes it, which cpack obeys.
execute_process(COMMAND find ${CPACK_TEMPORARY_DIRECTORY} -mindepth 1 -type d -exec chmod 755 {} +
                COMMAND_ERROR_IS_FATAL ANY)
