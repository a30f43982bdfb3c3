# bash completion for selfcal
_selfcal() {
  local cur=${COMP_WORDS[COMP_CWORD]} prev=${COMP_WORDS[COMP_CWORD - 1]} command=${COMP_WORDS[1]-} words
  if [[ $prev == --method || $prev == --effects ]]; then
    command=identify
    if [[ $prev == --method ]]; then command=identifiable; fi
    words=$("${COMP_WORDS[0]}" "$command" --help 2>/dev/null | sed -n "s/^ *$prev .*{\(.*\)}.*/\1/p")
    words=${words//,/ }
    mapfile -t COMPREPLY < <(compgen -W "$words" -- "$cur")
    return
  fi
  if [[ $prev == --log ]]; then
    mapfile -t COMPREPLY < <(compgen -W "debug info warning error" -- "$cur")
    return
  fi
  case $COMP_CWORD:$command in
    1:*) words="identify identifiable plan compensate diagnose trial simulate robot data serve bridge monitor command history report --help --version" ;;
    *:identify) words="--fix --free --effects --out --json --help" ;;
    *:diagnose) words="--sim --tool --since --next --cell --out --json --help" ;;
    2:trial) words="seal run score --help" ;;
    *:trial) words="--make --seed --measure --rows --robot --truth --baseline --jobs --out --json --help" ;;
    *:identifiable) words="--method --unknown --lock --count --seed --json --help" ;;
    *:compensate) words="--nominal --payload --payload-centre --temperature --all --controller --out --help" ;;
    *:plan) words="--method --separate --step --unknown --lock --count --candidates --criterion --workspace --start --prior --further --spacing --longest --groups --noise --noise-angle --speed --target --seed --out --json --help" ;;
    *:simulate) words="--out --live --touches --truth --help" ;;
    2:robot) words="check convert --help" ;;
    *:robot) words="--convention --base --tip --fixed --to --like --out --help" ;;
    2:data) words="check --help" ;;
    *:data) words="--help" ;;
    *:serve) words="--check --simulate --sessions --truth --log --help" ;;
    *:bridge) words="--action --touch --touch-gpio --acceleration --patience --help" ;;
    *:monitor) words="--robot --domain --once --wait --json --web --allow-commands --token --help" ;;
    2:command) words="start check diagnose done abort accept reject rollback --help" ;;
    *:command) words="--robot --domain --wait --json --help" ;;
    *:history) words="--newest --events --export --report --json --help" ;;
    *:report) words="--out --help" ;;
    *) words="--help" ;;
  esac
  if [[ $cur == -* || $COMP_CWORD -eq 1 || $COMP_CWORD:$command == 2:@(robot|data|command|trial) ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$words" -- "$cur")
  else
    mapfile -t COMPREPLY < <(compgen -f -- "$cur")
  fi
}
complete -o filenames -F _selfcal selfcal
