# bash completion for selfcal: what its own --help says of commands, options and their values
_selfcal() {
  local program=${COMP_WORDS[0]} cur=${COMP_WORDS[COMP_CWORD]} help option values words=""
  local -a command=() before=("${COMP_WORDS[@]:0:COMP_CWORD}")
  help=$("$program" --help 2>/dev/null)
  for option in "${before[@]:1}"; do
    [[ $help == *$'\nSubcommands:\n'* ]] || break
    command+=("$option")
    help=$("$program" "${command[@]}" --help 2>/dev/null)
  done

  # --to V and --to=V, which bash parts at the equals sign; of --effects A B any word up to the next option.
  if [[ $cur == = ]]; then
    cur=""
  elif [[ ${before[-1]} == = ]]; then
    unset 'before[-1]'
  fi
  option=${before[-1]}
  if [[ $option != --* ]]; then
    option=$(printf '%s\n' "${before[@]}" | grep -e '^--' | tail -n 1)
    grep -qE -e "^ *$option [A-Z]+:[^ ]* \.\.\." <<<"$help" || option=""
  fi
  values=$(sed -nE "s/^ *${option:-[A-Z]+} [A-Z]+:\{([^}]*)\}.*/\1/p" <<<"$help")

  if [[ $help == *$'\nSubcommands:\n'* ]]; then
    words=$(sed -n '1,/^Subcommands:/d; s/^  \([a-z][a-z]*\).*/\1/p' <<<"$help")
  elif [[ -n $values && ($option == --* || ($cur != -* && $COMP_CWORD -eq $((${#command[@]} + 1)))) ]]; then
    words=${values//,/ }
  fi
  if [[ $cur == -* || ${#command[@]} -eq 0 ]]; then
    words+=" "$(sed -nE 's/^ *(-[a-z],)?(--[a-z-]+).*/\2/p' <<<"$help")
  fi
  if [[ -n $words ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$words" -- "$cur")
  else
    mapfile -t COMPREPLY < <(compgen -f -- "$cur")
  fi
}
complete -o filenames -F _selfcal selfcal
