# bash completion for selfcal
_selfcal() {
  local cur=${COMP_WORDS[COMP_CWORD]} prev=${COMP_WORDS[COMP_CWORD - 1]} command=${COMP_WORDS[1]-} words
  if [[ $prev == --method ]]; then
    words="position location distance position-constraint location-constraint plane plane-normal sphere"
    mapfile -t COMPREPLY < <(compgen -W "$words" -- "$cur")
    return
  fi
  case $COMP_CWORD:$command in
    1:*) words="identify identifiable simulate robot --help --version" ;;
    *:identify) words="--fix --free --out --json --help" ;;
    *:identifiable) words="--method --unknown --count --seed --json --help" ;;
    *:simulate) words="--out --truth --help" ;;
    2:robot) words="check --help" ;;
    *) words="--help" ;;
  esac
  if [[ $cur == -* || $COMP_CWORD -eq 1 || $COMP_CWORD:$command == 2:robot ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$words" -- "$cur")
  else
    mapfile -t COMPREPLY < <(compgen -f -- "$cur")
  fi
}
complete -o filenames -F _selfcal selfcal
