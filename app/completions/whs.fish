# SPDX-License-Identifier: Apache-2.0
# Completes whs in fish; files are left to the shell.
complete -c whs -a '(whs --complete (commandline -opc)[2..-1] (commandline -ct) 2>/dev/null)'
