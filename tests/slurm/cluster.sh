# SPDX-License-Identifier: Apache-2.0
# Sourced: a Slurm cluster of this one machine, in a folder of its own, without systemd.

# startCluster FOLDER: munged, slurmctld, slurmd on loopback; exports SLURM_CONF. Needs root.
startCluster() {
  local folder=$1 host
  host=$(hostname -s)
  mkdir -p "$folder"/{state,spool}
  head -c 128 /dev/urandom >"$folder/munge.key"
  chmod 400 "$folder/munge.key"
  cat >"$folder/slurm.conf" <<CONF
ClusterName=boresight
SlurmctldHost=$host(127.0.0.1)
SlurmUser=root
SlurmctldPort=16817
SlurmdPort=16818
AuthType=auth/munge
AuthInfo=socket=$folder/munge.socket,cred_expire=5
CredType=cred/munge
ProctrackType=proctrack/pgid
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
MpiDefault=none
ReturnToService=2
JobRequeue=1
KillWait=2
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.pid
SlurmctldLogFile=$folder/slurmctld.log
SlurmdLogFile=$folder/slurmd.log
NodeName=$host NodeAddr=127.0.0.1 CPUs=$(nproc) State=UNKNOWN
PartitionName=test Nodes=$host Default=YES MaxTime=INFINITE State=UP
CONF
  export SLURM_CONF="$folder/slurm.conf"
  munged --force --foreground --key-file="$folder/munge.key" --socket="$folder/munge.socket" \
    --pid-file="$folder/munged.pid" --seed-file="$folder/munge.seed" >"$folder/munged.log" 2>&1 &
  cluster_processes=($!)
  waitFor "munged" test -S "$folder/munge.socket"
  slurmctld -D >"$folder/slurmctld.out" 2>&1 &
  cluster_processes+=($!)
  slurmd -D -N "$host" >"$folder/slurmd.out" 2>&1 &
  cluster_processes+=($!)
  waitFor "an idle node" nodeIsIdle
}

nodeIsIdle() { [ "$(sinfo --noheader --format=%t 2>/dev/null)" = idle ]; }

# Ends the processes that startCluster started, and only these.
stopCluster() {
  local process
  for process in "${cluster_processes[@]-}"; do
    [ -z "$process" ] || kill "$process" 2>/dev/null || true
  done
  for process in "${cluster_processes[@]-}"; do
    [ -z "$process" ] || wait "$process" 2>/dev/null || true
  done
}

# waitFor WHAT COMMAND...: until the command succeeds, for two minutes.
waitFor() {
  local what=$1 tries
  shift
  for tries in $(seq 600); do
    if "$@"; then return 0; fi
    sleep 0.2
  done
  echo "waited in vain for $what" >&2
  return 1
}
