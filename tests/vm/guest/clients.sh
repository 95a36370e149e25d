# The script of a machine that stands for a computer of somebody's (tests/vm/clients.sh): mounts its disk, /dev/vdb, and tells
# /vm/story in there, with the words of report.sh and the programs of /vm/bin.
mkdir /system
mount -t ext4 /dev/vdb /system || failed clients "the disk cannot be mounted"
mount --bind /vm /system/vm
mount --bind /out /system/out
mount --bind /dev /system/dev
mount -t proc proc /system/proc
mount -t sysfs sysfs /system/sys
mount -t configfs configfs /system/sys/kernel/config
mount -t tmpfs tmpfs /system/tmp
mount -t tmpfs tmpfs /system/run
export PAGER=cat LC_ALL=C
unset LD_LIBRARY_PATH
PATH=/vm/bin:/usr/sbin:/usr/bin chroot /system /bin/bash -c 'cd /tmp; . /vm/report.sh; . /vm/story' </dev/null
