# SPDX-License-Identifier: Apache-2.0
# Completes boresight in fish; files are left to the shell.
complete -c boresight -n 'string match -q -- "-*" (commandline -ct)' \
  -a '(boresight --help 2>/dev/null | string match -ar -- "--[a-z-]+")'
