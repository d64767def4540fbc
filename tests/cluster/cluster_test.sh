#!/usr/bin/env bash
# `duoptic batch run --slurm` on a cluster of one controller and two nodes, all on this machine's loopback: one node is killed with all
# that runs on it, then the controller, then a worker. All tasks get done, and are to the byte what one local run gives.
#   cluster_test.sh TOOL      exit 77: skipped
set -euo pipefail
tool=$(realpath "$1")
export PATH=$PATH:/usr/sbin

skip() { echo "skipped: $1"; exit 77; }
for program in slurmctld slurmd sbatch squeue scontrol; do
  command -v "$program" >/dev/null || skip "no Slurm ($program); tools/setup cluster installs it"
done
[[ $(id -u) -eq 0 ]] || skip "slurmd runs jobs as root alone"

folder=$(mktemp -d)
cd "$folder"
mkdir log spool.n1 spool.n2 state
host=$(hostname -s)
export SLURM_CONF=$folder/slurm.conf
cat >slurm.conf <<CONF
ClusterName=test
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=17990
SlurmUser=root
SlurmdUser=root
AuthType=auth/none
CredType=cred/none
CommunicationParameters=NoInAddrAny,NoCtldInAddrAny
StateSaveLocation=$folder/state
SlurmctldPidFile=$folder/slurmctld.pid
SlurmctldLogFile=$folder/log/slurmctld.log
SlurmdPidFile=$folder/slurmd.%n.pid
SlurmdSpoolDir=$folder/spool.%n
SlurmdLogFile=$folder/log/%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SwitchType=switch/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SlurmdParameters=config_overrides
SlurmdTimeout=5
ReturnToService=2
JobRequeue=1
NodeName=n1 NodeHostname=$host NodeAddr=127.0.0.1 Port=17991 CPUs=1 RealMemory=2000
NodeName=n2 NodeHostname=$host NodeAddr=127.0.0.1 Port=17992 CPUs=1 RealMemory=2000
PartitionName=all Nodes=ALL Default=YES State=UP
CONF

# tasks_of NODE: the processes that run on it, and what holds them; nothing else of this machine has this folder's configuration.
tasks_of() {
  local environment process parent
  for environment in $(grep -lzs "^SLURMD_NODENAME=$1$" /proc/[0-9]*/environ); do
    grep -qzs "^SLURM_CONF=$SLURM_CONF$" "$environment" || continue
    process=${environment%/environ}
    echo "${process#/proc/}"
    parent=$(awk '/^PPid/ { print $2 }' "$process/status" 2>/dev/null || true)
    [[ -n $parent && $(cat "/proc/$parent/comm" 2>/dev/null) == slurmstepd* ]] && echo "$parent"
  done | sort -u
}
kill_node() {
  kill -9 "$(cat "slurmd.$1.pid")" 2>/dev/null || true
  local process
  for process in $(tasks_of "$1"); do kill -9 "$process" 2>/dev/null || true; done
}
finish() {
  local status=$?
  trap - EXIT
  [[ -n ${runner:-} ]] && kill "$runner" 2>/dev/null
  [[ -f slurmctld.pid ]] && kill -9 "$(cat slurmctld.pid)" 2>/dev/null
  kill_node n1
  kill_node n2
  if [[ $status -ne 0 ]]; then tail -n 30 run.txt log/*.log cluster/slurm/*.txt 2>/dev/null; fi
  cd /
  rm -rf "$folder"
  exit $status
}
trap finish EXIT
fail() { echo "FAILED: $1"; exit 1; }
# until SECONDS COMMAND: waits for it to be true.
until_true() {
  local end=$((SECONDS + $1))
  shift
  while ! "$@"; do
    ((SECONDS < end)) || fail "waited in vain for: $*"
    sleep 0.25
  done
}
say() { printf '%4d s  %s\n' "$SECONDS" "$1"; }

slurmctld -i
slurmd -N n1
slurmd -N n2
until_true 20 bash -c '[[ $(sinfo -h -o %T) == idle ]]'
say "a controller and two nodes"

# Slow on purpose, so that all that is killed is at work: plain loops.
"$tool" synth --script wave --frames 12 --size 160x120 --quiet -o clip >/dev/null
for i in 01 02 03 04 05 06 07 08 09 10 11 12; do
  mkdir -p "archive/p$i"
  cp clip/left.avi clip/right.avi "archive/p$i/"
done
cp clip/calibration_truth.yml archive/
options=(--depth -- --engine ref --max-disparity 48)
"$tool" batch plan archive -o serial "${options[@]}" >/dev/null
"$tool" batch run serial --local --jobs 1 --quiet
say "12 recordings, done by one local run"

"$tool" batch plan archive -o cluster "${options[@]}" >/dev/null
"$tool" batch run cluster --slurm --retries 10 >run.txt 2>&1 &
runner=$!
at_work() { [[ -n $(tasks_of "$1" | xargs -r -I{} cat /proc/{}/comm 2>/dev/null | grep duoptic) ]]; }
done_tasks() { ls cluster/done 2>/dev/null | wc -l; }

# What an administrator does with nodes whose jobs the controller forgot.
resume_nodes() {
  local node state
  while read -r node state; do
    [[ $state == *drain* || $state == *down* ]] && kill -0 "$(cat "slurmd.$node.pid" 2>/dev/null)" 2>/dev/null &&
      scontrol update "NodeName=$node" State=RESUME 2>/dev/null
  done < <(sinfo -h -N -o '%N %T' 2>/dev/null)
  true
}
workers() { for p in $(tasks_of n1; tasks_of n2); do tr '\0' ' ' <"/proc/$p/cmdline" 2>/dev/null | grep -q 'batch work' && echo "$p"; done; }
a_worker() { resume_nodes; worker=$(workers | head -n 1); [[ -n $worker ]]; }

until_true 120 at_work n1
kill_node n1
say "node n1 is killed with all that ran there; $(done_tasks) of 12 done"
until_true 120 at_work n2
sleep 6  # the controller keeps its state every few seconds
kill -9 "$(cat slurmctld.pid)"
say "the controller is killed; $(done_tasks) of 12 done"
sleep 2
slurmctld
slurmd -N n1
say "the controller and n1 are back"
until_true 120 a_worker
kill -9 "$worker"
say "a worker is killed; $(done_tasks) of 12 done"
while kill -0 "$runner" 2>/dev/null; do
  resume_nodes
  ((SECONDS < 300)) || fail "not done after 300 s"
  sleep 0.5
done
wait "$runner" || fail "batch run ended with $?"
runner=
say "$(tail -n 3 run.txt | head -n 1)"

for done_folder in serial/done/*; do
  key=$(basename "$done_folder")
  cmp "$done_folder/SHA256SUMS" "cluster/done/$key/SHA256SUMS" || fail "$key differs from the local run"
  (cd "cluster/done/$key" && sha256sum --check --quiet SHA256SUMS) || fail "$key is not whole"
done
[[ $(done_tasks) -eq 12 && -z $(ls cluster/work) && -z $(ls cluster/faults) ]] || fail "something is left or missing"
lists=$(ls cluster/slurm/todo.* | wc -l)
start=$(date +%s%N)
"$tool" batch run cluster --slurm --quiet || fail "a run again ended with $?"
again_ms=$((($(date +%s%N) - start) / 1000000))
[[ $(ls cluster/slurm/todo.* | wc -l) -eq $lists ]] || fail "a run again submitted something"
say "all are those of the local run; a run again took $again_ms ms and submitted nothing"
